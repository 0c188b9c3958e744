#include "bench/accuracy_methods.h"

#include "bench/accuracy_scene.h"
#include "bench/opencv_baselines.h"
#include "stereomotion/detection/detect_balls.h"

namespace stereomotion::bench {
namespace {

class OwnMethod : public CenterMethod {
 public:
  OwnMethod(std::string name, DetectorMethod method)
      : name_(std::move(name)), detector_(StudySensor(), Options(method)) {}

  [[nodiscard]] std::string name() const override { return name_; }

  void Find(const Image& image, std::vector<FoundCenter>& found) override {
    detector_.Detect(image.View(), balls_);
    found.clear();
    for (const BallObservation& ball : balls_) {
      if (ball.status == BlobStatus::kOk) found.push_back({ball.center_px, ball.covariance_px2});
    }
  }

 private:
  static DetectionOptions Options(DetectorMethod method) {
    DetectionOptions options;
    options.method = method;
    return options;
  }

  std::string name_;
  BallDetector detector_;
  std::vector<BallObservation> balls_;
};

class BaselineMethod : public CenterMethod {
 public:
  using Function = void (*)(const cv::Mat&, const BallHints&, std::vector<Eigen::Vector2d>&);
  BaselineMethod(std::string name, Function function, const BallHints& hints)
      : name_(std::move(name)), function_(function), hints_(hints) {}

  [[nodiscard]] std::string name() const override { return name_; }

  void Find(const Image& image, std::vector<FoundCenter>& found) override {
    const ImageView view = image.View();
    const cv::Mat grey(view.height_px, view.width_px, CV_8UC1, const_cast<std::uint8_t*>(view.data),
                       static_cast<std::size_t>(view.stride_bytes));
    centers_.clear();
    function_(hints_.smooth_px > 0 ? Smooth(grey) : grey, hints_, centers_);
    found.clear();
    for (const Eigen::Vector2d& center_px : centers_) found.push_back({center_px, {}});
  }

 private:
  cv::Mat Smooth(const cv::Mat& grey) {
    cv::GaussianBlur(grey, smoothed_, {}, hints_.smooth_px);
    return smoothed_;
  }

  std::string name_;
  Function function_;
  BallHints hints_;
  cv::Mat smoothed_;
  std::vector<Eigen::Vector2d> centers_;
};

}  // namespace

std::vector<std::unique_ptr<CenterMethod>> MakeMethods(const Condition& condition, double peak_dn) {
  // Above this the balls' limbs stand out of the noise pixel by pixel.
  constexpr double kClear_db = 25;
  BallHints hints;
  hints.diameter_px = condition.diameter_px;
  hints.length_px = condition.diameter_px * (1 + condition.smear_diameters);
  hints.amplitude_dn = peak_dn;
  hints.background_dn = StudyBackgroundDn();
  hints.smooth_px = condition.snr_db < kClear_db ? 1 : 0;
  std::vector<std::unique_ptr<CenterMethod>> methods;
  const auto own = [&](const char* name, DetectorMethod method) {
    methods.push_back(std::make_unique<OwnMethod>(name, method));
  };
  const auto baseline = [&](const char* name, BaselineMethod::Function function) {
    methods.push_back(std::make_unique<BaselineMethod>(name, function, hints));
  };
  own("ml", DetectorMethod::kMaximumLikelihood);
  own("wavelet", DetectorMethod::kWavelet);
  own("centroid", DetectorMethod::kCentroid);
  baseline("moments", FindByMoments);
  baseline("simple_blob", FindBySimpleBlobDetector);
  baseline("canny_ellipse", FindByCannyEllipse);
  baseline("hough", FindByHoughCircles);
  return methods;
}

}  // namespace stereomotion::bench
