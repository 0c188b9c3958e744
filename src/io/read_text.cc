#include "read_text.h"

#include <fstream>
#include <ios>
#include <iterator>

#include "stereomotion/core/user_error.h"

namespace stereomotion {

// The whole file at once: a failing disk or a folder must not surface inside a parser.
std::string ReadText(const std::filesystem::path& file, const std::string& what) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw UserError(file.string() + ": found a folder, expected " + what);
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw UserError(file.string() + ": cannot be read, expected " + what);
  std::string text;
  try {
    text.assign(std::istreambuf_iterator<char>(stream), {});
  } catch (const std::ios_base::failure&) {
    throw UserError(file.string() + ": cannot be read to its end, expected " + what);
  }
  constexpr const char* kByteOrderMark = "\xEF\xBB\xBF";
  return text.rfind(kByteOrderMark, 0) == 0 ? text.substr(3) : text;
}

}  // namespace stereomotion
