#include <mutex>

#include "file_names.h"
#include "frame_stream.h"
#include "list_frames.h"
#include "stereomotion/capture/read_image.h"
#include "stereomotion/capture/sha256.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;
using Files = std::vector<fs::path>;

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
  fs::path pairs_of() const override {
    if (listing_.frames.front().pair == kPairNotTold) return {};
    std::error_code none;
    return fs::canonical(folder_, none).parent_path();
  }

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
  FrameListing listing_;
  mutable std::mutex mutex_;
  mutable std::vector<std::string> digests_;  // a digest a frame, empty until it is read
};

}  // namespace

std::unique_ptr<FrameStream> OpenImageFolder(const fs::path& folder, const StreamOptions& options) {
  return std::make_unique<ImageFolder>(folder, options);
}

}  // namespace stereomotion
