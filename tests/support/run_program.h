#pragma once

#include <string>
#include <vector>

namespace stereomotion::testing {

/// Holds how a program ended.
struct ProgramRun {
  int exit_code = -1;
  std::string output;  ///< standard output and error together
};

/// Runs a program and waits for it. `arguments` are passed as they are (each is quoted for the
/// shell), `environment` is put before the program ("NAME=value").
ProgramRun RunProgram(const std::string& program, const std::vector<std::string>& arguments,
                      const std::vector<std::string>& environment = {});

}  // namespace stereomotion::testing
