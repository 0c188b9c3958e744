#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "stereomotion/core/median.h"
#include "stereomotion/detection/detect_balls.h"
#include "stereomotion/detection/estimate_noise.h"
#include "tests/support/number_table.h"
#include "tests/support/recording_run.h"

// The dots of a real target (real/control_frame_myptv): painted, 5–6 px wide, many dim, many with a
// glint, on a textured plate.

namespace stereomotion::testing {
namespace {

constexpr std::array<DetectorMethod, 2> kMethods = {DetectorMethod::kMaximumLikelihood,
                                                    DetectorMethod::kWavelet};
/// A detection so near to the peer's centre is the same dot; the peer's repeat to about 0.3 px.
constexpr double kSameDot_px = 1.5;

std::filesystem::path Folder() { return SharedData() / "real/control_frame_myptv"; }

/// Holds what one camera shows: the peer's dots and what each method gives for each.
struct Dots {
  std::vector<Eigen::Vector2d> peer_px;
  std::array<std::vector<BallObservation>, 2> balls;
};

Dots DetectDots(int camera) {
  const std::string number = std::to_string(camera);
  const Image image = ReadGrey(Folder() / ("cal" + number + ".tif"));
  Dots dots;
  for (const auto& row : ReadNumbers(Folder() / ("cam" + number + "_cal_points"))) {
    dots.peer_px.emplace_back(row.at(0), row.at(1));
  }
  DetectionOptions options;
  options.max_balls = 2000;  // the plate's texture shows hundreds of specks beside the dots
  const SensorNoise noise = EstimateNoise({image.View()}).value();
  for (std::size_t m = 0; m < kMethods.size(); ++m) {
    options.method = kMethods[m];
    dots.balls[m] = DetectBalls(image.View(), noise, options);
  }
  return dots;
}

const BallObservation* Nearest(const std::vector<BallObservation>& balls,
                               const Eigen::Vector2d& place_px, bool only_ok) {
  const BallObservation* nearest = nullptr;
  double least_px = kSameDot_px;
  for (const BallObservation& ball : balls) {
    const double distance_px = (ball.center_px - place_px).norm();
    if (distance_px >= least_px || (only_ok && ball.status != BlobStatus::kOk)) continue;
    least_px = distance_px;
    nearest = &ball;
  }
  return nearest;
}

class RealDotsTest : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(Folder())) GTEST_SKIP() << Folder() << " is not here";
    dots_ = DetectDots(GetParam());
  }
  Dots dots_;
};

/// Without knowing where to look; `FindControlPoints`, which knows, finds all
/// (calibrate_frame_test). The missing ones are the dimmest, below 10 dB.
TEST_P(RealDotsTest, NearlyAllAreFoundUnaided) {
  int found = 0;
  int measured = 0;
  for (const Eigen::Vector2d& peer_px : dots_.peer_px) {
    found += Nearest(dots_.balls[0], peer_px, false) != nullptr ? 1 : 0;
    measured += Nearest(dots_.balls[0], peer_px, true) != nullptr ? 1 : 0;
  }
  fmt::print("camera {}: {} dots, {} found, {} measured\n", GetParam(), dots_.peer_px.size(), found,
             measured);
  EXPECT_GE(found, 0.95 * static_cast<double>(dots_.peer_px.size()));
}

/// Issue 4, bar 4: half-shaded dots draw neither centre. The median, for in uneven paint with
/// glints the edge and the light of a dot have different middles: some differ by tenths.
TEST_P(RealDotsTest, EdgesAndLightAgree) {
  std::vector<double> differences_px;
  for (const Eigen::Vector2d& peer_px : dots_.peer_px) {
    const BallObservation* first = Nearest(dots_.balls[0], peer_px, true);
    const BallObservation* second = Nearest(dots_.balls[1], peer_px, true);
    if (first == nullptr || second == nullptr) continue;
    differences_px.push_back((first->center_px - second->center_px).norm() / std::sqrt(2.0));
  }
  ASSERT_GE(differences_px.size(), dots_.peer_px.size() / 2);
  const double median_px = Median(differences_px);
  fmt::print("camera {}: ml and wavelet differ by {:.4f} px an axis (median of {} dots)\n",
             GetParam(), median_px, differences_px.size());
  EXPECT_LE(median_px, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Cameras, RealDotsTest, ::testing::Values(1, 2, 3));

}  // namespace
}  // namespace stereomotion::testing
