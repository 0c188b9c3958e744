#include "list_frames.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "file_names.h"
#include "stereomotion/capture/read_image.h"
#include "stereomotion/core/user_error.h"
#include "timestamps_csv.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;
using Files = std::vector<fs::path>;

// Numbers that differ from the file's by the same shift name the same frames (from 0, from 1).
bool IsConstantShift(const std::vector<FrameInfo>& rows, const std::vector<std::int64_t>& numbers) {
  if (rows.size() != numbers.size()) return false;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].index - numbers[i] != rows[0].index - numbers[0]) return false;
  }
  return true;
}

std::size_t CountCommon(const std::vector<FrameInfo>& rows,
                        const std::vector<std::int64_t>& numbers) {
  return static_cast<std::size_t>(
      std::count_if(rows.begin(), rows.end(), [&](const FrameInfo& row) {
        return std::binary_search(numbers.begin(), numbers.end(), row.index);
      }));
}

std::string Ranges(const std::vector<FrameInfo>& rows, const std::vector<std::int64_t>& numbers) {
  return "the rows are frames " + std::to_string(rows.front().index) + " to " +
         std::to_string(rows.back().index) + ", the names are numbered " +
         std::to_string(numbers.front()) + " to " + std::to_string(numbers.back());
}

// Both ends off in the same direction: counting from 0 here and from 1 there looks like that.
bool LooksShifted(const std::vector<FrameInfo>& rows, const std::vector<std::int64_t>& numbers) {
  const bool later = numbers.front() > rows.front().index && numbers.back() > rows.back().index;
  const bool earlier = numbers.front() < rows.front().index && numbers.back() < rows.back().index;
  return later || earlier;
}

std::string ShiftTakenInOrder(const fs::path& csv, const std::vector<FrameInfo>& rows,
                              const std::vector<std::int64_t>& numbers) {
  return csv.string() + ": " + Ranges(rows, numbers) +
         ": as many and shifted alike, so they are taken in order, the first row for the first "
         "image; if images are missing at one end, the times are wrong";
}

FrameListing MatchByNumber(const fs::path& csv, const std::vector<FrameInfo>& rows,
                           const Files& files, const std::vector<std::int64_t>& numbers,
                           std::size_t common) {
  FrameListing listing{rows, Files(rows.size()), {}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto found = std::lower_bound(numbers.begin(), numbers.end(), rows[i].index);
    if (found == numbers.end() || *found != rows[i].index) continue;
    listing.files[i] = files[static_cast<std::size_t>(found - numbers.begin())];
  }
  if (common < rows.size()) {
    listing.warnings.push_back(csv.string() + ": " + std::to_string(rows.size() - common) +
                               " rows have no image; those frames are lost");
  }
  if (common < files.size()) {
    listing.warnings.push_back(csv.string() + ": " + std::to_string(files.size() - common) +
                               " images have no row, so no time; they are left out");
  }
  if (LooksShifted(rows, numbers)) {
    listing.warnings.push_back(csv.string() + ": " + Ranges(rows, numbers) +
                               ": matched by number, but names and rows may be shifted (counted "
                               "from another start); then every image has a wrong time");
  }
  return listing;
}

}  // namespace

std::vector<fs::path> ListImages(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error)) throw UserError(folder.string() + ": no such folder");
  Files files;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (IsImageFile(it->path()) && it->path().filename().string()[0] != '.') {
      files.push_back(it->path());
    }
  }
  if (error) throw UserError(folder.string() + ": cannot be listed (" + error.message() + ")");
  if (files.empty()) {
    throw UserError(folder.string() +
                    ": holds no images, expected PNG, TIFF, PGM, BMP or JPEG files");
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return NaturalLess(a.filename().string(), b.filename().string());
  });
  return files;
}

FrameListing ListWithTimes(const fs::path& csv, const Files& files) {
  const std::vector<FrameInfo> rows = ReadTimestamps(csv);
  const auto numbers = FrameNumbers(files);
  const std::string found = csv.string() + ": found " + std::to_string(rows.size()) + " rows for " +
                            std::to_string(files.size()) + " images";
  if (!numbers) {
    if (rows.size() == files.size()) return {rows, files, {}};
    throw UserError(found + " whose names do not number them, expected a row an image");
  }
  const std::size_t common = CountCommon(rows, *numbers);
  if (IsConstantShift(rows, *numbers)) {
    FrameListing listing{rows, files, {}};
    const bool shifted = common > 0 && common < rows.size();
    if (shifted) listing.warnings.push_back(ShiftTakenInOrder(csv, rows, *numbers));
    return listing;
  }
  if (common > 0) return MatchByNumber(csv, rows, files, *numbers, common);
  throw UserError(found + ": " + Ranges(rows, *numbers) +
                  "; expected the same numbers, or a row an image");
}

FrameListing ListByRate(const fs::path& folder, const Files& files, double fps) {
  if (!(fps > 0)) {
    throw UserError(
        folder.string() +
        ": no timestamps.csv, so the frames have no times; give --fps, or add the file");
  }
  const auto numbers = FrameNumbers(files);
  std::int64_t step = 0;
  for (std::size_t i = 1; numbers && i < numbers->size(); ++i) {
    step = std::gcd(step, (*numbers)[i] - (*numbers)[i - 1]);
  }
  FrameListing listing{std::vector<FrameInfo>(files.size()), files, {}};
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto position = static_cast<std::int64_t>(i);
    const std::int64_t tick = step > 0 ? ((*numbers)[i] - numbers->front()) / step : position;
    listing.frames[i].index = numbers ? (*numbers)[i] : position;
    listing.frames[i].timestamp_ns = std::llround(static_cast<double>(tick) / fps * 1e9);
  }
  return listing;
}

}  // namespace stereomotion
