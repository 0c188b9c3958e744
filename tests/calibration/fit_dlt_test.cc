#include <gtest/gtest.h>

#include <cmath>

#include "stereomotion/calibration/dlt.h"
#include "stereomotion/geometry/so3.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::Normal;
using testing::NormalVector;
using testing::Uniform;

struct View {
  CameraModel model;
  Rigid3 cam_from_world;
  std::vector<Eigen::Vector3d> points_mm;
  std::vector<Eigen::Vector2d> pixels_px;
};

CameraModel UsualModel() {
  CameraModel model;
  model.fx_px = 1650;
  model.fy_px = 1640;
  model.cx_px = 645;
  model.cy_px = 500;
  return model;
}

View MakeView(int count, std::mt19937_64& rng, double sigma_px = 0) {
  View view{UsualModel(), {ExpSO3({0.3, -0.5, 0.2}), {40, -30, 2300}}, {}, {}};
  for (int i = 0; i < count; ++i) {
    view.points_mm.emplace_back(Uniform(rng, -400, 400), Uniform(rng, -300, 300),
                                Uniform(rng, -300, 300));
    const auto pixel = view.model.Project(view.cam_from_world * view.points_mm.back());
    view.pixels_px.push_back(*pixel + sigma_px * NormalVector<2>(rng));
  }
  return view;
}

Eigen::Vector2d Apply(const Eigen::Matrix<double, 3, 4>& dlt, const Eigen::Vector3d& p_mm) {
  return (dlt * p_mm.homogeneous()).hnormalized();
}

TEST(FitDlt, ExactPointsGiveTheCameraBack) {
  auto rng = MakeTestRng();
  for (const int count : {6, 7, 30}) {
    const View view = MakeView(count, rng);
    const auto dlt = FitDlt(view.points_mm, view.pixels_px);
    ASSERT_TRUE(dlt);
    EXPECT_NEAR((dlt->block<1, 3>(2, 0).norm()), 1, 1e-12);
    for (const auto& p : view.points_mm) EXPECT_GT(dlt->row(2) * p.homogeneous(), 0);
    const DltCamera camera = DecomposeDlt(*dlt);
    EXPECT_FALSE(camera.mirrored);
    EXPECT_NEAR(camera.model.fx_px, view.model.fx_px, 1e-4);
    EXPECT_NEAR(camera.model.fy_px, view.model.fy_px, 1e-4);
    EXPECT_NEAR(camera.model.cx_px, view.model.cx_px, 1e-4);
    EXPECT_NEAR(camera.model.cy_px, view.model.cy_px, 1e-4);
    EXPECT_NEAR(camera.skew_px, 0, 1e-4);
    EXPECT_LT(PerturbationBetween(view.cam_from_world, camera.cam_from_world).norm(), 1e-3);
  }
}

TEST(FitDlt, ChangeOfWorldFrame) {
  auto rng = MakeTestRng();
  View view = MakeView(12, rng, 0.2);
  const auto before = FitDlt(view.points_mm, view.pixels_px);
  const Rigid3 moved_from_world{ExpSO3({1.2, 0.4, -2}), {5000, -800, 300}};
  for (auto& p : view.points_mm) p = moved_from_world * p;
  const auto after = FitDlt(view.points_mm, view.pixels_px);
  ASSERT_TRUE(before && after);
  for (const auto& p : view.points_mm) {
    EXPECT_LT((Apply(*before, moved_from_world.Inverse() * p) - Apply(*after, p)).norm(), 1e-6);
  }
}

TEST(FitDlt, PlanarPointsDetermineNothing) {
  auto rng = MakeTestRng();
  View view = MakeView(20, rng);
  const Rigid3 tilt{ExpSO3({0.4, 0.3, 0}), {10, 20, 30}};
  for (std::size_t i = 0; i < view.points_mm.size(); ++i) {
    view.points_mm[i].z() = 0;
    view.points_mm[i] = tilt * view.points_mm[i];
    view.pixels_px[i] =
        *view.model.Project(view.cam_from_world * view.points_mm[i]) + 0.3 * NormalVector<2>(rng);
  }
  EXPECT_FALSE(FitDlt(view.points_mm, view.pixels_px));
}

TEST(FitDlt, FivePointsDetermineNothing) {
  auto rng = MakeTestRng();
  const View view = MakeView(5, rng);
  EXPECT_FALSE(FitDlt(view.points_mm, view.pixels_px));
}

TEST(FitDlt, UnequalListsAreTheCallersMistake) {
  EXPECT_THROW(FitDlt(std::vector<Eigen::Vector3d>(6), std::vector<Eigen::Vector2d>(7)),
               std::invalid_argument);
}

TEST(FitDlt, LeftHandedSurveyIsFlagged) {
  auto rng = MakeTestRng();
  View view = MakeView(10, rng, 0.2);
  for (auto& p : view.points_mm) p.y() = -p.y();
  const auto dlt = FitDlt(view.points_mm, view.pixels_px);
  ASSERT_TRUE(dlt);
  for (const auto& p : view.points_mm) EXPECT_GT(dlt->row(2) * p.homogeneous(), 0);
  const DltCamera camera = DecomposeDlt(*dlt);
  EXPECT_TRUE(camera.mirrored);
  EXPECT_NEAR(camera.cam_from_world.rotation.norm(), 1, 1e-12);
  EXPECT_GT(camera.model.fx_px, 0);
}

TEST(FitDlt, ResidualsAreTheNoise) {
  auto rng = MakeTestRng();
  constexpr int kDraws = 400, kCount = 20;
  constexpr double kSigma_px = 0.3;
  double chi2 = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const View view = MakeView(kCount, rng, kSigma_px);
    const auto dlt = FitDlt(view.points_mm, view.pixels_px);
    ASSERT_TRUE(dlt);
    for (int i = 0; i < kCount; ++i) {
      chi2 += (Apply(*dlt, view.points_mm[i]) - view.pixels_px[i]).squaredNorm() /
              (kSigma_px * kSigma_px);
    }
  }
  // 40 equations, 11 unknowns: χ² with 29 degrees of freedom if it were the maximum of likelihood;
  // the algebraic error's own weights may lose a little, not a whole unknown.
  constexpr double kDof = 2 * kCount - 11;
  const double spread = std::sqrt(2 * kDof / kDraws);
  EXPECT_GT(chi2 / kDraws, kDof - 4 * spread);
  EXPECT_LT(chi2 / kDraws, kDof + 1 + 4 * spread);
}

}  // namespace
}  // namespace stereomotion
