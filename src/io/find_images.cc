#include "find_images.h"

#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;
using Files = std::vector<fs::path>;

bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

// Pads every run of digits with zeros, so that plain comparison orders the numbers.
std::string SortKey(const fs::path& file) {
  constexpr std::size_t kWidth = 20;  // digits of the largest 64-bit number
  const std::string name = file.filename().string();
  std::string key;
  for (std::size_t i = 0; i < name.size();) {
    std::size_t end = i;
    while (end < name.size() && IsDigit(name[end])) ++end;
    const std::size_t digits = end - i;
    if (digits > 0 && digits < kWidth) key.append(kWidth - digits, '0');
    key.append(name, i, std::max<std::size_t>(digits, 1));
    i += std::max<std::size_t>(digits, 1);
  }
  return key;
}

bool IsImage(const fs::path& file) {
  static constexpr std::array<const char*, 8> kEndings = {".png", ".tif", ".tiff", ".pgm",
                                                          ".pnm", ".bmp", ".jpg",  ".jpeg"};
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

bool HasWildcard(const std::string& text) { return text.find_first_of("*?") != std::string::npos; }

Files ListFolder(const YamlReader& node, const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    node.Fail("'" + node.Text() + "', but there is no folder " + folder.string(), "images");
  }
  Files files;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().filename().string()[0] != '.') files.push_back(it->path());
  }
  if (error) throw UserError(folder.string() + ": cannot be listed (" + error.message() + ")");
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    const std::string first = SortKey(a), second = SortKey(b);
    return first == second ? a.filename() < b.filename() : first < second;
  });
  return files;
}

Files Matching(const YamlReader& node, const fs::path& folder, const std::string& pattern) {
  const Files all = ListFolder(node, folder);
  Files files;
  for (const fs::path& file : all) {
    const std::string name = file.filename().string();
    const bool named =
        HasWildcard(pattern) ? fnmatch(pattern.c_str(), name.c_str(), 0) == 0 : name == pattern;
    if (pattern.empty() ? IsImage(file) : named) files.push_back(file);
  }
  if (files.empty()) {
    const std::string example = all.empty() ? "" : ", the first " + all[0].filename().string();
    node.Fail("'" + node.Text() + "', which fits none of the " + std::to_string(all.size()) +
                  " files in " + folder.string() + example,
              "images: PNG, TIFF, PGM, BMP or JPEG");
  }
  for (const fs::path& file : files) {
    if (!IsImage(file)) node.Fail(file.string(), "images: PNG, TIFF, PGM, BMP or JPEG");
  }
  return files;
}

}  // namespace

std::vector<fs::path> FindImages(const YamlReader& node) {
  const fs::path given = node.Text();
  if (given.empty()) node.Fail("nothing", "a pattern as cam0/*.png, a folder or a file");
  if (HasWildcard(given.parent_path().string())) {
    node.Fail("'" + given.string() + "'", "* and ? behind the last / only");
  }
  const fs::path path = node.file().parent_path() / given;
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return Matching(node, path, "");
  const std::string name = path.filename().string();
  if (!HasWildcard(name) && !fs::exists(path, ignored)) {
    node.Fail("'" + given.string() + "', but there is no " + path.string(),
              "a pattern as cam0/*.png, a folder or a file");
  }
  return Matching(node, path.has_parent_path() ? path.parent_path() : fs::path("."), name);
}

}  // namespace stereomotion
