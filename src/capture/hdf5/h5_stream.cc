#include "h5_stream.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <new>

#include "../image_digests.h"
#include "h5_images.h"
#include "h5_rows.h"
#include "stereomotion/capture/recorder.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

std::string CheckedCamera(const fs::path& file, const std::string& camera) {
  const std::vector<std::string> cameras = CamerasOfRecording(file);
  if (std::find(cameras.begin(), cameras.end(), camera) != cameras.end()) return camera;
  std::string names;
  for (const std::string& name : cameras) names += (names.empty() ? "" : ", ") + name;
  throw UserError(file.string() + ": holds no camera '" + camera + "', expected one of: " + names);
}

class H5Stream : public FrameStream {
 public:
  H5Stream(const fs::path& file, const std::string& camera, const StreamOptions& options)
      : file_(file) {
    if (NeedsRepair(file)) {
      const RepairReport repair = RepairRecording(file);
      warnings_.push_back(file.string() + ": was not finished and has been repaired");
      warnings_.insert(warnings_.end(), repair.notes.begin(), repair.notes.end());
    }
    const std::string group = "/" + CheckedCamera(file, camera) + "/";
    const H5Lock lock;
    images_ = std::make_unique<H5ImageReader>(file, group + "images");
    rows_ = ReadH5Rows(H5Reader(file), group, images_->shape().frames, options.fps);
    const std::string missing = images_->Missing();
    if (!missing.empty()) warnings_.push_back(missing);
    if (options.hash_images) digests_ = std::make_unique<ImageDigests>(rows_.frames.size());
  }

  const std::vector<FrameInfo>& frames() const override { return rows_.frames; }
  bool has_timestamps() const override { return rows_.has_times; }
  std::string times_name() const override { return "timestamp_ns"; }
  bool is_numbered() const override { return rows_.has_numbers; }
  const std::vector<std::string>& warnings() const override { return warnings_; }
  fs::path pairs_of() const override {
    std::error_code none;  // it was opened, so it is there
    return rows_.has_pairs ? fs::canonical(file_, none) : fs::path();
  }

  void ReadImage(std::int64_t position, Frame& frame) const override {
    frame.problem = images_->Read(position, frame.image);
    if (!digests_ || !frame.problem.empty()) return;
    const FrameInfo& info = rows_.frames[static_cast<std::size_t>(position)];
    digests_->Add(position, frame.image.View(),
                  std::to_string(info.index) + "," + std::to_string(info.timestamp_ns));
  }

  std::string InputDigest() const override { return digests_ ? digests_->Digest() : ""; }

 private:
  fs::path file_;
  std::vector<std::string> warnings_;
  std::unique_ptr<H5ImageReader> images_;
  H5Rows rows_;
  std::unique_ptr<ImageDigests> digests_;
};

}  // namespace

std::unique_ptr<FrameStream> OpenH5Stream(const fs::path& file, const std::string& camera,
                                          const StreamOptions& options) {
  try {
    return std::make_unique<H5Stream>(file, camera, options);
  } catch (const std::bad_alloc&) {
    throw UserError(file.string() +
                    ": says that it holds more frames than fit into memory; it is " +
                    "damaged, or not a recording");
  }
}

}  // namespace stereomotion
