#pragma once

#include <filesystem>
#include <string>

namespace stereomotion::app {

/// Tells what the disk is like on which `output` comes to lie.
struct DiskState {
  double free_bytes = 0;
  double write_bytes_s = 0;  ///< as measured; 0: not measured
};

/// Asks for the free room and writes a file for a fraction of a second, which it removes. Makes
/// no folder for the output. Throws `OutputError` where nothing can be written there.
DiskState LookAtDisk(const std::filesystem::path& output);

/// Asks for the free room; 0 where that is not known.
double FreeBytes(const std::filesystem::path& output);

/// Says in words for how long the room lasts at a rate.
std::string RoomInWords(double free_bytes, double bytes_s);

}  // namespace stereomotion::app
