#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <deque>
#include <mutex>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "frame_stream.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

std::string CodecName(const cv::VideoCapture& capture) {
  const int code = static_cast<int>(capture.get(cv::CAP_PROP_FOURCC));
  std::string name;
  for (int shift = 0; shift < 32; shift += 8) {
    const char c = static_cast<char>(code >> shift & 0xFF);
    if (c > ' ' && c < 127) name += c;
  }
  return name;
}

bool IsLossless(const std::string& codec) {
  static constexpr std::array<const char*, 14> kLossless = {"FFV1", "HFYU", "FFVH", "GREY", "Y800",
                                                            "Y8",   "Y16",  "RGBA", "BGR",  "I420",
                                                            "MPNG", "PNG",  "ULRG", "DIB"};
  return codec.empty() || std::find(kLossless.begin(), kLossless.end(), codec) != kLossless.end();
}

// Decoding runs forward only; a few decoded frames are kept for readers that come out of order.
class VideoStream : public FrameStream {
 public:
  VideoStream(const std::filesystem::path& file, const StreamOptions& options)
      : file_(file), capture_(file.string()) {
    if (!capture_.isOpened()) {
      throw UserError(file.string() +
                      ": cannot be opened, expected a folder of images or a video file");
    }
    const double own_fps = capture_.get(cv::CAP_PROP_FPS);
    const double fps = options.fps > 0 ? options.fps : own_fps;
    if (!(fps > 0) || !std::isfinite(fps)) {
      throw UserError(file.string() + ": carries no frame rate; give --fps");
    }
    const double count = capture_.get(cv::CAP_PROP_FRAME_COUNT);
    if (!(count >= 1)) throw UserError(file.string() + ": holds no frames");
    frames_.resize(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      frames_[i].index = static_cast<std::int64_t>(i);
      frames_[i].timestamp_ns = std::llround(static_cast<double>(i) / fps * 1e9);
    }
    const std::string codec = CodecName(capture_);
    if (!IsLossless(codec)) {
      warnings_.push_back(file.string() + ": the codec " + codec +
                          " is lossy: ball centres lose accuracy and the stated uncertainties do " +
                          "not cover that; record PNG, TIFF or FFV1");
    }
  }

  const std::vector<FrameInfo>& frames() const override { return frames_; }
  bool has_timestamps() const override { return false; }
  bool is_numbered() const override { return false; }
  const std::vector<std::string>& warnings() const override { return warnings_; }
  std::vector<std::filesystem::path> InputFiles() const override { return {file_}; }

  void ReadImage(std::int64_t position, Frame& frame) const override {
    const std::lock_guard lock(mutex_);
    const cv::Mat* gray = Find(position);
    frame.problem.clear();
    if (gray == nullptr) {
      frame.image.Resize(0, 0, PixelType::kGray8);
      frame.problem = file_.string() + ": frame " + std::to_string(position) +
                      " cannot be decoded (the file ends early or is damaged)";
      return;
    }
    frame.image.Resize(gray->cols, gray->rows, PixelType::kGray8);
    for (int v = 0; v < gray->rows; ++v) {
      std::memcpy(frame.image.Row<std::uint8_t>(v), gray->ptr(v),
                  static_cast<std::size_t>(gray->cols));
    }
  }

 private:
  static constexpr std::size_t kWindow = 16;

  const cv::Mat* Find(std::int64_t position) const {
    const auto window_begin = next_ - static_cast<std::int64_t>(window_.size());
    if (position < window_begin) Rewind();
    while (next_ <= position) {
      if (!DecodeNext()) return nullptr;
    }
    const auto back = static_cast<std::size_t>(next_ - position);
    return &window_[window_.size() - back];
  }
  void Rewind() const {
    capture_.open(file_.string());  // from the start: seeking by number is not exact in all formats
    window_.clear();
    next_ = 0;
  }
  bool DecodeNext() const {
    if (!capture_.read(color_) || color_.empty()) return false;
    cv::Mat gray;
    if (window_.size() >= kWindow) {
      gray = window_.front();  // recycles the oldest frame's memory
      window_.pop_front();
    }
    if (color_.channels() == 1) {
      color_.copyTo(gray);
    } else {
      cv::cvtColor(color_, gray, cv::COLOR_BGR2GRAY);
    }
    window_.push_back(gray);
    ++next_;
    return true;
  }

  std::filesystem::path file_;
  std::vector<FrameInfo> frames_;
  std::vector<std::string> warnings_;
  mutable std::mutex mutex_;
  mutable cv::VideoCapture capture_;
  mutable cv::Mat color_;
  mutable std::deque<cv::Mat> window_;  // the frames before `next_`
  mutable std::int64_t next_ = 0;
};

}  // namespace

std::unique_ptr<FrameStream> OpenVideo(const std::filesystem::path& file,
                                       const StreamOptions& options) {
  return std::make_unique<VideoStream>(file, options);
}

}  // namespace stereomotion
