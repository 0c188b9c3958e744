#pragma once

#include <filesystem>
#include <string>

#include "stereomotion/core/user_error.h"
#include "tests/capture/temporary_folder.h"

namespace stereomotion::testing {

/// Runs `action`; returns the message of its `UserError`, or "no error".
template <class Action>
std::string Error(const Action& action) {
  try {
    action();
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

inline bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Holds one file in a folder of its own.
class TextFile {
 public:
  TextFile(const std::string& name, const std::string& text) : path_(folder_.Write(name, text)) {}
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  TemporaryFolder folder_;
  std::filesystem::path path_;
};

inline std::filesystem::path SourceFile(const std::string& name) {
  return std::filesystem::path(STEREOMOTION_SOURCE_DIR) / name;
}

}  // namespace stereomotion::testing
