#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "stereomotion/calibration/find_board.h"
#include "tests/support/board_image.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::BoardImageOptions;
using testing::ErrorStatistics;
using testing::MakeTestRng;
using testing::Uniform;

constexpr int kViews = 24;

struct Condition {
  const char* name;
  Target target;
  CameraModel camera;
  double blur_px = 0.6;
  double light_slope = 0;
  bool inverted = false;
};

constexpr int kConditions = 8;

class FindBoardMonteCarlo : public ::testing::TestWithParam<Condition> {};

/// A pose that fills about half of a 640 × 480 image, turned up to 35° out of the image's plane.
Rigid3 DrawPose(const Target& target, const CameraModel& camera, std::mt19937_64& rng) {
  const Eigen::Vector3d size_mm = target.points.back().xyz_mm - target.points.front().xyz_mm;
  const double distance_mm = camera.fx_px * size_mm.norm() / 480;
  const Eigen::Vector3d middle_mm(Uniform(rng, -0.05, 0.05) * distance_mm,
                                  Uniform(rng, -0.05, 0.05) * distance_mm, distance_mm);
  const Eigen::Vector3d turn_rad(Uniform(rng, -0.6, 0.6), Uniform(rng, -0.6, 0.6),
                                 Uniform(rng, -0.4, 0.4));
  return testing::PlaceBoard(target, turn_rad, middle_mm);
}

Image Draw(const Condition& tested, const Rigid3& cam_from_board, std::mt19937_64& rng) {
  BoardImageOptions options;
  options.noise = SensorNoise{58.8, 60, 0, 255};
  options.blur_px = tested.blur_px;
  options.light_slope = tested.light_slope;
  options.inverted = tested.inverted;
  options.seed = rng();
  return testing::RenderBoard(tested.target, tested.camera, cam_from_board, options);
}

std::vector<Eigen::Vector2d> Truth(const Condition& tested, const Rigid3& cam_from_board) {
  return tested.target.type == TargetType::kCircleGrid
             ? testing::OutlineCenters(tested.target, tested.camera, cam_from_board)
             : testing::ProjectPoints(tested.target, tested.camera, cam_from_board);
}

TEST_P(FindBoardMonteCarlo, CovarianceIsTheSpread) {
  const Condition& tested = GetParam();
  auto rng = MakeTestRng();
  ErrorStatistics errors;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double variance_px2 = 0;
  std::size_t expected = 0;
  for (int view = 0; view < kViews; ++view) {
    const Rigid3 cam_from_board = DrawPose(tested.target, tested.camera, rng);
    const Image image = Draw(tested, cam_from_board, rng);
    const auto truth_px = Truth(tested, cam_from_board);
    for (const Eigen::Vector2d& at_px : truth_px) {
      // A tag's size within the border: then it is seen whole, with white around it.
      const Eigen::Vector2d end_px(639, 479);
      expected += std::min(at_px.minCoeff(), (end_px - at_px).minCoeff()) > 60 ? 1 : 0;
    }
    for (const BoardPoint& point : FindBoard(image.View(), tested.target).points) {
      const Eigen::Vector2d error_px = point.pixel_px - truth_px[point.point];
      errors.Add(error_px, point.covariance_px2);
      sum += error_px;
      variance_px2 += point.covariance_px2.trace() / 2;
    }
  }
  EXPECT_GE(errors.samples(), static_cast<int>(0.99 * static_cast<double>(expected)));
  const double ratio = errors.nees_per_dof();
  EXPECT_TRUE(std::fabs(errors.nees_z()) < testing::FamilyZ(kConditions) ||
              (ratio > 0.95 && ratio < 1.05))
      << ratio;
  // The worst of so many is one that chance makes in a thousandth of such tests.
  EXPECT_GT(errors.samples() * testing::ChiSquareTail(errors.worst_nees(), 2), 1e-3);
  const double sigma_of_mean = std::sqrt(variance_px2) / errors.samples();
  EXPECT_LT(sum.cwiseAbs().maxCoeff() / errors.samples(), 3.5 * sigma_of_mean);
}

CameraModel Straight() { return {800, 800, 319.3, 239.6}; }
CameraModel Bent() { return {800, 800, 319.3, 239.6, -0.2, 0.05, 5e-4, -5e-4, 0}; }

INSTANTIATE_TEST_SUITE_P(
    Boards, FindBoardMonteCarlo,
    ::testing::Values(Condition{"tags", testing::TagBoard(), Straight()},
                      Condition{"tags_bent", testing::TagBoard(), Bent()},
                      Condition{"tags_blurred", testing::TagBoard(), Straight(), 1.2},
                      Condition{"tags_in_uneven_light", testing::TagBoard(), Straight(), 0.6, 0.4},
                      Condition{"circles", testing::CircleBoard(), Straight()},
                      Condition{"circles_white", testing::CircleBoard(), Straight(), 0.8, 0.3,
                                true},
                      Condition{"chessboard", testing::ChessBoard(), Straight()},
                      Condition{"chessboard_bent", testing::ChessBoard(), Bent(), 1.0}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace stereomotion
