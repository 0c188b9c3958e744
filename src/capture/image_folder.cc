#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

#include "file_names.h"
#include "frame_stream.h"
#include "stereomotion/capture/read_image.h"
#include "stereomotion/capture/sha256.h"
#include "stereomotion/core/user_error.h"
#include "timestamps_csv.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;
using Files = std::vector<fs::path>;

Files ListImages(const fs::path& folder) {
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

struct Listing {
  std::vector<FrameInfo> frames;
  Files files;  // a file a frame; empty path: the image is missing
  std::vector<std::string> warnings;
};

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

Listing MatchByNumber(const fs::path& csv, const std::vector<FrameInfo>& rows, const Files& files,
                      const std::vector<std::int64_t>& numbers, std::size_t common) {
  Listing listing{rows, Files(rows.size()), {}};
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

Listing ListWithTimes(const fs::path& csv, const Files& files) {
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
    Listing listing{rows, files, {}};
    const bool shifted = common > 0 && common < rows.size();
    if (shifted) listing.warnings.push_back(ShiftTakenInOrder(csv, rows, *numbers));
    return listing;
  }
  if (common > 0) return MatchByNumber(csv, rows, files, *numbers, common);
  throw UserError(found + ": " + Ranges(rows, *numbers) +
                  "; expected the same numbers, or a row an image");
}

Listing ListByRate(const fs::path& folder, const Files& files, double fps) {
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
  Listing listing{std::vector<FrameInfo>(files.size()), files, {}};
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto position = static_cast<std::int64_t>(i);
    const std::int64_t tick = step > 0 ? ((*numbers)[i] - numbers->front()) / step : position;
    listing.frames[i].index = numbers ? (*numbers)[i] : position;
    listing.frames[i].timestamp_ns = std::llround(static_cast<double>(tick) / fps * 1e9);
  }
  return listing;
}

class ImageFolder : public FrameStream {
 public:
  ImageFolder(const fs::path& folder, const StreamOptions& options)
      : folder_(folder), hash_images_(options.hash_images) {
    const Files files = ListImages(folder);
    numbered_ = FrameNumbers(files).has_value();
    const fs::path csv = folder / "timestamps.csv";
    std::error_code ignored;
    has_timestamps_ = fs::exists(csv, ignored);
    listing_ = has_timestamps_ ? ListWithTimes(csv, files) : ListByRate(folder, files, options.fps);
    digests_.resize(hash_images_ ? listing_.files.size() : 0);
  }

  const std::vector<FrameInfo>& frames() const override { return listing_.frames; }
  bool has_timestamps() const override { return has_timestamps_; }
  bool is_numbered() const override { return numbered_; }
  const std::vector<std::string>& warnings() const override { return listing_.warnings; }

  void ReadImage(std::int64_t position, Frame& frame) const override {
    // One buffer a decoding thread, so that nothing is allocated once it has grown.
    thread_local std::vector<std::uint8_t> bytes;
    const fs::path& file = listing_.files[static_cast<std::size_t>(position)];
    frame.problem = file.empty() ? "no image for this row of timestamps.csv" : "";
    if (frame.problem.empty()) frame.problem = ReadBytes(file, bytes);
    if (!frame.problem.empty()) {
      frame.image.Resize(0, 0, PixelType::kGray8);
    } else {
      if (hash_images_) Remember(position, bytes);
      frame.problem = DecodeImage(bytes, frame.image);
    }
    if (!frame.problem.empty()) {
      frame.problem =
          (file.empty() ? folder_ / "timestamps.csv" : file).string() + ": " + frame.problem;
    }
  }

  std::string InputDigest() const override {
    const std::lock_guard lock(mutex_);
    Sha256 all;
    bool any = false;
    for (std::size_t i = 0; i < digests_.size(); ++i) {
      if (digests_[i].empty()) continue;
      const std::string line = digests_[i] + "  " + listing_.files[i].filename().string() + "\n";
      all.Add(line.data(), line.size());
      any = true;
    }
    return any ? all.HexDigest() : "";
  }
  Files InputFiles() const override {
    if (!has_timestamps_) return {};
    return {folder_ / "timestamps.csv"};
  }

 private:
  void Remember(std::int64_t position, const std::vector<std::uint8_t>& bytes) const {
    Sha256 hash;
    hash.Add(bytes.data(), bytes.size());
    std::string digest = hash.HexDigest();
    const std::lock_guard lock(mutex_);
    digests_[static_cast<std::size_t>(position)] = std::move(digest);
  }

  fs::path folder_;
  bool hash_images_ = false;
  bool numbered_ = false;
  bool has_timestamps_ = false;
  Listing listing_;
  mutable std::mutex mutex_;
  mutable std::vector<std::string> digests_;  // a digest a frame, empty until it is read
};

}  // namespace

std::unique_ptr<FrameStream> OpenImageFolder(const fs::path& folder, const StreamOptions& options) {
  return std::make_unique<ImageFolder>(folder, options);
}

}  // namespace stereomotion
