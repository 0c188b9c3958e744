#include "tests/support/detection_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "stereomotion/capture/recording.h"
#include "stereomotion/detection/estimate_noise.h"
#include "stereomotion/io/body_file.h"
#include "tests/support/truth.h"

namespace stereomotion::testing {
namespace {

constexpr int kNoiseImages = 8;
constexpr double kSamePlace_px = 1;
constexpr double kWrong_sigma = 5;

std::vector<FramePair> ReadAll(const PairSource& source) {
  std::vector<FramePair> pairs(static_cast<std::size_t>(source.size()));
  for (std::int64_t i = 0; i < source.size(); ++i) {
    source.Read(i, pairs[static_cast<std::size_t>(i)]);
  }
  return pairs;
}

const Frame& FrameOf(const FramePair& pair, int camera) {
  return camera == 0 ? pair.left : pair.right;
}

SensorNoise LearnNoiseOf(const std::vector<FramePair>& pairs, int camera,
                         const DetectionOptions& options) {
  std::vector<ImageView> images;
  for (const FramePair& pair : pairs) {
    if (static_cast<int>(images.size()) < kNoiseImages) {
      images.push_back(FrameOf(pair, camera).image.View());
    }
  }
  return EstimateNoise(images, options).value_or(SensorNoise{});
}

void AddFound(const BallObservation& ball, const TrueBall& truth, DetectionScore& score) {
  const Eigen::Vector2d error_px = ball.center_px - truth.outline_px;
  ++score.found;
  score.centers.Add(error_px, ball.covariance_px2);
  bool wrong = false;
  for (int axis = 0; axis < 2; ++axis) {
    const double variance_px2 = ball.covariance_px2(axis, axis);
    score.axes[static_cast<std::size_t>(axis)].Add(error_px.segment<1>(axis),
                                                   Eigen::Matrix<double, 1, 1>(variance_px2));
    wrong |= std::fabs(error_px[axis]) > kWrong_sigma * std::sqrt(variance_px2);
  }
  score.wrong += wrong ? 1 : 0;
}

void ScoreImage(const std::vector<BallObservation>& balls, const std::vector<TrueBall>& truth,
                double least_visible, DetectionScore& score) {
  ++score.images;
  const auto distance_px = [](const BallObservation& ball, const TrueBall& true_ball) {
    return (ball.center_px - true_ball.outline_px).norm();
  };
  for (const TrueBall& true_ball : truth) {
    if (!true_ball.inside || true_ball.visible < least_visible) continue;
    ++score.shown;
    for (const BallObservation& ball : balls) {
      if (ball.status != BlobStatus::kOk || distance_px(ball, true_ball) > kSamePlace_px) continue;
      AddFound(ball, true_ball, score);
      break;
    }
  }
  for (const BallObservation& ball : balls) {
    const bool near = std::any_of(truth.begin(), truth.end(), [&](const TrueBall& true_ball) {
      return distance_px(ball, true_ball) < 0.5 * true_ball.diameter_px;
    });
    if (ball.status == BlobStatus::kOk && !near) ++score.false_detections;
  }
}

}  // namespace

double DetectionScore::axis_rmse_px() const { return centers.rmse() / std::sqrt(2.0); }

DetectionScore ScoreDetections(const std::filesystem::path& recording,
                               const DetectionOptions& options, double least_visible) {
  const Truth truth = ReadTruth(recording, ReadBody(recording / "body.yaml"), {"cam0", "cam1"});
  const std::vector<FramePair> pairs =
      ReadAll(*OpenRecording(recording / "cam0", recording / "cam1"));
  DetectionScore score;
  std::vector<BallObservation> balls;
  for (int camera = 0; camera < 2; ++camera) {
    BallDetector detector(LearnNoiseOf(pairs, camera, options), options);
    for (const FramePair& pair : pairs) {
      detector.Detect(FrameOf(pair, camera).image.View(), balls);
      const TrueFrame& frame = truth.at(FrameOf(pair, camera).index);
      ScoreImage(balls, frame.balls[static_cast<std::size_t>(camera)], least_visible, score);
    }
  }
  return score;
}

std::string DetectionHeader() {
  return fmt::format("{:24} {:>6} {:>6} {:>8} {:>7} {:>9} {:>9} {:>9} {:>9} {:>7} {:>6} {:>6}\n",
                     "", "shown", "found", "recall %", "false/i", "RMSE px", "stated", "bias u",
                     "bias v", "NEES/n", "z", "max z");
}

std::string DetectionRow(const std::string& name, const DetectionScore& score) {
  return fmt::format(
      "{:24} {:6d} {:6d} {:8.2f} {:7.2f} {:9.5f} {:9.5f} {:9.5f} {:9.5f} {:7.3f} {:6.2f} {:6.2f}\n",
      name, score.shown, score.found, 100 * score.recall(), score.false_per_image(),
      score.axis_rmse_px(), score.centers.stated_rmse() / std::sqrt(2.0), score.axes[0].bias(),
      score.axes[1].bias(), score.centers.nees_per_dof(), score.centers.nees_z(),
      score.centers.worst_z());
}

}  // namespace stereomotion::testing
