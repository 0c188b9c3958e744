#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stereomotion {

/// Notes in run.json, under the key `analysis`, with which command and filter the files of motion
/// were made again; all else in it stays. A RUN without run.json gets none. Throws `UserError` for
/// a run.json that is none.
void NoteAnalysis(const std::filesystem::path& run, const std::vector<std::string>& command,
                  const std::string& filter);

}  // namespace stereomotion
