#include "stereomotion/stereo/match_balls.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/stereo/stereo_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::Observe;
using testing::StereoScene;
using testing::Uniform;

constexpr double kRadiusMm = 10;
using Balls = std::vector<BallObservation>;

std::vector<StereoCandidate> Match(const StereoScene& scene, const Balls& left, const Balls& right,
                                   double radius_mm = kRadiusMm, const MatchOptions& options = {}) {
  std::vector<StereoCandidate> candidates;
  FindStereoCandidates(scene.left, scene.right, left, right, radius_mm, options, candidates);
  return candidates;
}

/// Spreads balls over the height, so that no two share an epipolar line.
std::vector<Eigen::Vector3d> Column(int count) {
  std::vector<Eigen::Vector3d> points_mm;
  for (int i = 0; i < count; ++i) {
    points_mm.emplace_back(60 * (i % 3) - 60, -300 + 600.0 * i / count, 40 * (i % 5));
  }
  return points_mm;
}

Balls ObserveAll(const RigCamera& camera, const std::vector<Eigen::Vector3d>& points_mm) {
  Balls balls;
  for (const auto& p_mm : points_mm) balls.push_back(Observe(camera, p_mm, kRadiusMm));
  return balls;
}

TEST(FindStereoCandidates, ExactBallsGiveTheirCentres) {
  const StereoScene scene;
  const auto points_mm = Column(12);
  Balls right = ObserveAll(scene.right, points_mm);
  std::reverse(right.begin(), right.end());
  const auto candidates = Match(scene, ObserveAll(scene.left, points_mm), right);
  ASSERT_EQ(candidates.size(), 12U);
  for (int i = 0; i < 12; ++i) {
    EXPECT_EQ(candidates[i].left, i);
    EXPECT_EQ(candidates[i].right, 11 - i);
    // Two steps leave the shift's change over the first step's error: 0.01 px · 1e-5, in depth.
    EXPECT_NEAR((candidates[i].point.p_in_world_mm - points_mm[i]).norm(), 0, 1e-5);
  }
}

TEST(FindStereoCandidates, WithoutRadiusTheShiftStaysIn) {
  const StereoScene scene;
  const Eigen::Vector3d p_mm(400, 200, -200);
  const Balls left{Observe(scene.left, p_mm, 40)}, right{Observe(scene.right, p_mm, 40)};
  const auto removed = Match(scene, left, right, 40), kept = Match(scene, left, right, 0);
  ASSERT_EQ(removed.size(), 1U);
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_NEAR((removed[0].point.p_in_world_mm - p_mm).norm(), 0, 1e-4);
  EXPECT_GT((kept[0].point.p_in_world_mm - p_mm).norm(), 0.01);
}

TEST(FindStereoCandidates, GateLiesWhereItSays) {
  const StereoScene scene;
  const Eigen::Vector3d p_mm(50, 80, 20);
  const Balls left{Observe(scene.left, p_mm, kRadiusMm, 0.3)};
  Balls right{Observe(scene.right, p_mm, kRadiusMm, 0.4)};
  MatchOptions options;
  options.rig_slack_px = 1;
  // Nearly vertical offset = nearly along the epipolar normal. Equal weights would put the distance
  // on 1/√2 of it; σ² = (0.3² + 0.4²)/2 + 1².
  const double gate_px = std::sqrt(2.0) * options.gate_sigma * std::sqrt(0.125 + 1);
  right[0].center_px.y() += 0.95 * gate_px;
  EXPECT_EQ(Match(scene, left, right, kRadiusMm, options).size(), 1U);
  right[0].center_px.y() += 0.10 * gate_px;
  EXPECT_EQ(Match(scene, left, right, kRadiusMm, options).size(), 0U);
}

TEST(FindStereoCandidates, GateWithoutSlackPassesNoiseAndCovarianceIsItsSpread) {
  const StereoScene scene;
  auto rng = testing::MakeTestRng();
  MatchOptions options;
  options.rig_slack_px = 0;
  constexpr int kRuns = 2000;
  constexpr double kSigmaPx = 0.02;
  double nees = 0;
  for (int i = 0; i < kRuns; ++i) {
    const Eigen::Vector3d p_mm(Uniform(rng, -400, 400), Uniform(rng, -300, 300),
                               Uniform(rng, -200, 200));
    Balls left{Observe(scene.left, p_mm, kRadiusMm, kSigmaPx)};
    Balls right{Observe(scene.right, p_mm, kRadiusMm, kSigmaPx)};
    left[0].center_px += kSigmaPx * testing::NormalVector<2>(rng);
    right[0].center_px += kSigmaPx * testing::NormalVector<2>(rng);
    const auto found = Match(scene, left, right, kRadiusMm, options);
    ASSERT_EQ(found.size(), 1U);  // 5 σ: one in 1.7 million is lost
    const Eigen::Vector3d error_mm = found[0].point.p_in_world_mm - p_mm;
    nees += error_mm.dot(found[0].point.covariance_mm2.ldlt().solve(error_mm));
  }
  EXPECT_GT(nees, testing::Chi2Quantile(3 * kRuns, -testing::kFamilyZ));
  EXPECT_LT(nees, testing::Chi2Quantile(3 * kRuns, testing::kFamilyZ));
}

TEST(FindStereoCandidates, RoughBallsCountAsHalfAPixel) {
  const StereoScene scene;
  const Eigen::Vector3d p_mm(50, 80, 20);
  Balls left{Observe(scene.left, p_mm, kRadiusMm, 0)};
  Balls right{Observe(scene.right, p_mm, kRadiusMm, 0.01)};
  left[0].status = BlobStatus::kPartly;  // with no covariance at all
  right[0].status = BlobStatus::kPoorFit;
  const auto rough = Match(scene, left, right);
  ASSERT_EQ(rough.size(), 1U);
  left[0] = Observe(scene.left, p_mm, kRadiusMm, 0.5);
  right[0] = Observe(scene.right, p_mm, kRadiusMm, std::hypot(0.5, 0.01));
  const auto half = Match(scene, left, right);
  EXPECT_NEAR((rough[0].point.covariance_mm2 - half[0].point.covariance_mm2).norm(), 0, 1e-9);
}

TEST(FindStereoCandidates, UnequalBallsAreNoPairUnlessPartlySeen) {
  const StereoScene scene;
  const Eigen::Vector3d p_mm(50, 80, 20);
  const Balls left{Observe(scene.left, p_mm, kRadiusMm)};
  Balls right{Observe(scene.right, p_mm, kRadiusMm)};
  right[0].semi_major_px *= 1.8;
  right[0].semi_minor_px *= 1.8;
  EXPECT_TRUE(Match(scene, left, right).empty());
  right[0].status = BlobStatus::kPartly;
  EXPECT_EQ(Match(scene, left, right).size(), 1U);
}

TEST(FindStereoCandidates, NothingBehindTheCameras) {
  const StereoScene scene;
  BallObservation ball = Observe(scene.left, {0, 0, 0}, kRadiusMm, 1);
  Balls left{ball}, right{ball};
  left[0].center_px = {39, 494};
  right[0].center_px = {1251, 501};
  MatchOptions wide;
  wide.gate_sigma = 1e3;
  EXPECT_TRUE(Match(scene, left, right, 0, wide).empty());
}

TEST(FindStereoCandidates, SwappedCamerasGiveTheSamePoints) {
  const StereoScene scene;
  const auto points_mm = Column(9);
  const Balls left = ObserveAll(scene.left, points_mm), right = ObserveAll(scene.right, points_mm);
  StereoScene swapped = scene;
  std::swap(swapped.left, swapped.right);
  const auto a = Match(scene, left, right), b = Match(swapped, right, left);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].left, b[i].right);
    EXPECT_NEAR((a[i].point.p_in_world_mm - b[i].point.p_in_world_mm).norm(), 0, 1e-7);
  }
}

TEST(FindStereoCandidates, ReusesAndClearsItsOutput) {
  const StereoScene scene;
  std::vector<StereoCandidate> candidates(5);
  FindStereoCandidates(scene.left, scene.right, {}, {}, 0, {}, candidates);
  EXPECT_TRUE(candidates.empty());
}

TEST(FindStereoCandidates, RejectsOptionsOutOfRange) {
  const StereoScene scene;
  EXPECT_THROW(Match(scene, {}, {}, -1), std::invalid_argument);
  MatchOptions options;
  options.gate_sigma = 0;
  EXPECT_THROW(Match(scene, {}, {}, 1, options), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
