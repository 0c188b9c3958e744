#include "stereomotion/io/body_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace stereomotion {
namespace {

/// Longer names do not fit into a path of some systems together with the files' own.
constexpr std::size_t kLongestName = 100;
constexpr const char* kExpected =
    "expected a name that can be a folder's: letters, digits, spaces and . _ - +, not beginning "
    "with a dot or a space and not ending with one";

bool IsPlain(char c) {
  const auto byte = static_cast<unsigned char>(c);
  constexpr unsigned char kFirstOfUtf8 = 0x80;
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == ' ' ||
         c == '.' || c == '_' || c == '-' || c == '+' || byte >= kFirstOfUtf8;
}

bool CanBeFolder(const std::string& name) {
  if (name.empty() || name.size() > kLongestName) return false;
  const auto edge = [](char c) { return c == '.' || c == ' '; };
  if (edge(name.front()) || edge(name.back())) return false;
  return std::all_of(name.begin(), name.end(), IsPlain);
}

std::string Lower(std::string name) {
  for (char& c : name) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return name;
}

}  // namespace

std::filesystem::path FolderOfBody(const std::filesystem::path& run,
                                   const std::vector<Body>& bodies, std::size_t body) {
  return bodies.size() == 1 ? run : run / bodies.at(body).name;
}

std::string BodyNameProblem(const std::vector<Body>& bodies) {
  if (bodies.size() < 2) return "";
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::string& name = bodies[i].name;
    if (name.empty()) {
      return fmt::format(
          "body {} of {} has no name: give it one (`name:`), its results go into a "
          "folder of that name",
          i + 1, bodies.size());
    }
    if (!CanBeFolder(name)) return fmt::format("name: found '{}', {}", name, kExpected);
    if (!seen.emplace(Lower(name), i).second) {
      return fmt::format(
          "name: found '{}' twice (capitals do not count), expected a name of its "
          "own for each body",
          name);
    }
  }
  return "";
}

}  // namespace stereomotion
