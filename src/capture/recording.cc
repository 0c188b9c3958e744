#include "stereomotion/capture/recording.h"

#include <algorithm>
#include <locale>
#include <sstream>
#include <stdexcept>

#include "frame_stream.h"
#include "hdf5/h5_stream.h"
#include "pair_streams.h"
#include "stereomotion/capture/read_image.h"
#include "stereomotion/capture/recorder.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<FrameStream> OpenStream(const fs::path& path, const StreamOptions& options) {
  if (path.empty()) throw UserError("an empty name, expected a folder of images or a video file");
  fs::path file;
  std::string camera;
  if (SplitRecordingArgument(path.string(), file, camera)) {
    return OpenH5Stream(file, camera, options);
  }
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return OpenImageFolder(path, options);
  if (!IsImageFile(path)) return OpenVideo(path, options);
  throw UserError(path.string() +
                  ": found a single image, expected a folder of images or a video file");
}

void RequireRate(double fps) {
  if (fps == 0 || (fps >= kLowestFps && fps <= kHighestFps)) return;
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "--fps: found " << fps << ", expected " << kLowestFps << " to " << kHighestFps
       << " frames a second";
  throw UserError(text.str());
}

std::int64_t CountExposures(const FrameStream& stream) {
  const auto& frames = stream.frames();
  return std::count_if(frames.begin(), frames.end(),
                       [](const FrameInfo& frame) { return frame.exposure_us > 0; });
}

std::string NumberRange(const std::vector<FrameInfo>& frames) {
  return std::to_string(frames.front().index) + " to " + std::to_string(frames.back().index);
}

class StreamPair : public Recording {
 public:
  StreamPair(const fs::path& left, const fs::path& right, const RecordingOptions& options)
      : left_(OpenStream(left, {options.fps, options.hash_images})),
        right_(OpenStream(right, {options.fps, options.hash_images})) {
    RequireSameClocks(left, right);
    Pair();
    Report(left, right);
    WarnOfAssumptions(left, right, options);
  }

  std::int64_t size() const override { return static_cast<std::int64_t>(partner_.size()); }
  const RecordingReport& report() const override { return report_; }

  bool Read(std::int64_t position, FramePair& pair) const override {
    if (position < 0 || position >= size())
      throw std::out_of_range("Recording::Read: no such pair");
    ReadFrame(*left_, position, pair.left);
    const std::int64_t partner = partner_[static_cast<std::size_t>(position)];
    if (partner >= 0) {
      ReadFrame(*right_, partner, pair.right);
    } else {
      pair.right.index = -1;
      pair.right.timestamp_ns = 0;
      pair.right.exposure_us = 0;
      pair.right.image.Resize(0, 0, PixelType::kGray8);
      pair.right.problem = "the left frame has no partner";
    }
    return true;
  }

  std::string InputDigest(Side side) const override { return Stream(side).InputDigest(); }
  std::vector<fs::path> InputFiles(Side side) const override { return Stream(side).InputFiles(); }

 private:
  [[nodiscard]] const FrameStream& Stream(Side side) const {
    return side == Side::kLeft ? *left_ : *right_;
  }
  static void ReadFrame(const FrameStream& stream, std::int64_t position, Frame& frame) {
    const FrameInfo& info = stream.frames()[static_cast<std::size_t>(position)];
    frame.index = info.index;
    frame.timestamp_ns = info.timestamp_ns;
    frame.exposure_us = info.exposure_us;
    stream.ReadImage(position, frame);
  }
  void RequireSameClocks(const fs::path& left, const fs::path& right) const {
    if (left_->has_timestamps() == right_->has_timestamps()) return;
    const bool left_has = left_->has_timestamps();
    throw UserError((left_has ? left : right).string() + ": has " +
                    (left_has ? left_ : right_)->times_name() + ", but " +
                    (left_has ? right : left).string() +
                    " has none; expected both (pairs are found by time), or neither and --fps");
  }
  void Pair() {
    StreamPairing pairing = PairStreams(*left_, *right_);
    report_.period_s = pairing.period_s;
    report_.paired_by_time = pairing.by_time;
    paired_by_number_ = pairing.by_number;
    partner_ = std::move(pairing.partner);
  }
  void Report(const fs::path& left, const fs::path& right) {
    report_.left_frames = size();
    report_.right_frames = static_cast<std::int64_t>(right_->frames().size());
    report_.unpaired_left = std::count(partner_.begin(), partner_.end(), -1);
    report_.left_with_exposure = CountExposures(*left_);
    report_.right_with_exposure = CountExposures(*right_);
    report_.pairs = report_.left_frames - report_.unpaired_left;
    report_.unpaired_right = report_.right_frames - report_.pairs;
    for (const auto* stream : {left_.get(), right_.get()}) {
      const auto& warnings = stream->warnings();
      report_.warnings.insert(report_.warnings.end(), warnings.begin(), warnings.end());
    }
    if (report_.unpaired_left > 0 || report_.unpaired_right > 0) WarnOfUnpaired(left, right);
  }
  void WarnOfUnpaired(const fs::path& left, const fs::path& right) {
    std::string text = left.string() + " has " + std::to_string(report_.left_frames) + " frames, " +
                       right.string() + " " + std::to_string(report_.right_frames) + ": " +
                       std::to_string(report_.unpaired_left) + " left and " +
                       std::to_string(report_.unpaired_right) + " right frames have no partner";
    if (report_.pairs == 0) {
      text += "; no pair at all: do both cameras' timestamps come from one clock?";
    } else if (paired_by_number_) {
      text += "; paired by the numbers in the names, as there is no timestamps.csv";
    } else if (!report_.paired_by_time) {
      text += "; paired in order: without timestamps.csv nothing tells when frames were lost";
    }
    report_.warnings.push_back(text);
  }
  void WarnOfAssumptions(const fs::path& left, const fs::path& right,
                         const RecordingOptions& options) {
    if (report_.paired_by_time && options.fps > 0) {
      report_.warnings.push_back("--fps is not used: " + (left / left_->times_name()).string() +
                                 " and the right camera's give the times");
    }
    const bool by_position = !report_.paired_by_time && !paired_by_number_;
    if (!by_position || !left_->is_numbered() || !right_->is_numbered()) return;
    const auto &a = left_->frames(), &b = right_->frames();
    if (a.front().index == b.front().index) return;
    report_.warnings.push_back(
        "the names number the images of " + left.string() + " " + NumberRange(a) + ", of " +
        right.string() + " " + NumberRange(b) +
        ": paired in order, the first with the first; if a camera lost frames at an end, the pairs "
        "are wrong: name partners alike, or add timestamps.csv");
  }

  std::unique_ptr<FrameStream> left_;
  std::unique_ptr<FrameStream> right_;
  bool paired_by_number_ = false;
  std::vector<std::int64_t> partner_;  // a left frame's right one, or −1
  RecordingReport report_;
};

}  // namespace

namespace {

// One camera may be named in several ways: "rec.h5:cam0", "./rec.h5:cam0".
bool AreTheSame(const fs::path& left, const fs::path& right) {
  std::error_code ignored;
  fs::path left_file, right_file;
  std::string left_camera, right_camera;
  if (SplitRecordingArgument(left.string(), left_file, left_camera) &&
      SplitRecordingArgument(right.string(), right_file, right_camera)) {
    return left_camera == right_camera && fs::equivalent(left_file, right_file, ignored);
  }
  return left == right || fs::equivalent(left, right, ignored);
}

}  // namespace

std::unique_ptr<Recording> OpenRecording(const fs::path& left, const fs::path& right,
                                         const RecordingOptions& options) {
  RequireRate(options.fps);
  if (AreTheSame(left, right)) {
    throw UserError(left.string() + ": left and right are the same, expected two cameras");
  }
  return std::make_unique<StreamPair>(left, right, options);
}

}  // namespace stereomotion
