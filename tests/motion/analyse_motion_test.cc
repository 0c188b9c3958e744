#include "stereomotion/motion/analyse_motion.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "motion/fit_recording.h"
#include "motion/thin_recording.h"
#include "stereomotion/geometry/so3.h"
#include "stereomotion/motion/marker_cluster.h"
#include "stereomotion/motion/pose_noise.h"
#include "tests/support/motion_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

/// Exceeded by three standard normal squares once in 100 000 runs.
constexpr double kChi2Of3 = 25.9;

MotionData Noisy(const testing::MotionPlan& plan) {
  auto rng = testing::MakeTestRng();
  const testing::MotionScene scene = testing::MakeMotionScene(plan, rng);
  return testing::Observed(scene, rng);
}

double Chi2(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance) {
  return error.dot(covariance.ldlt().solve(error));
}

TEST(AnalyseMotion, AllPartsOfAUniformMotion) {
  const testing::MotionPlan plan = testing::UniformMotion();
  const MotionAnalysis analysis = AnalyseMotion(Noisy(plan));
  EXPECT_EQ(analysis.spin.law, PathLaw::kUniform);
  ASSERT_TRUE(analysis.spin.center);
  ASSERT_TRUE(analysis.axis);
  ASSERT_TRUE(analysis.time_offset);
  EXPECT_FALSE(analysis.time_offset_applied);
  const auto truth = testing::TrueMotion(plan);
  ASSERT_EQ(analysis.samples.size(), truth.size());
  const std::size_t middle = truth.size() / 2;
  const MotionSample& sample = analysis.samples[middle];
  ASSERT_TRUE(sample.center);
  EXPECT_LT(Chi2(sample.center->position_mm - truth[middle].center_mm,
                 sample.center->covariance.topLeftCorner<3, 3>()),
            kChi2Of3);
  // v is the centre's, by its law.
  EXPECT_LT(Chi2(sample.velocity.velocity_mm_s - truth[middle].velocity_mm_s,
                 sample.velocity.covariance.block<3, 3>(3, 3)),
            kChi2Of3);
  EXPECT_LT(Chi2(sample.velocity.omega_rad_s - truth[middle].omega_rad_s,
                 sample.velocity.covariance.topLeftCorner<3, 3>()),
            kChi2Of3);
}

TEST(AnalyseMotion, TooFewPosesAreNamed) {
  MotionData data = Noisy(testing::FixedMotion());
  data.frames.resize(2);
  const MotionAnalysis analysis = AnalyseMotion(data);
  EXPECT_EQ(analysis.samples.size(), 2U);
  EXPECT_TRUE(analysis.spin.laws.empty());
  ASSERT_EQ(analysis.warnings.size(), 1U);
  EXPECT_NE(analysis.warnings[0].find("fewer than three poses"), std::string::npos);
}

// A thinned recording has the centre in every frame all the same, and an answer within what half
// the data tells more: the difference of the two is the noise of what was left out.
TEST(AnalyseMotion, ThinnedRecordingAgrees) {
  const MotionData data = Noisy(testing::UniformMotion());
  AnalyseOptions options;
  const MotionAnalysis whole = AnalyseMotion(data, options);
  options.max_joint_frames = (data.frames.size() + 1) / 2;
  const MotionAnalysis half = AnalyseMotion(data, options);
  ASSERT_TRUE(whole.spin.center && half.spin.center);
  ASSERT_EQ(half.spin.center->states.size(), data.frames.size());
  const Eigen::Matrix3d left_out =
      half.spin.center->covariance_mm2 - whole.spin.center->covariance_mm2;
  EXPECT_LT(Chi2(half.spin.center->in_body_mm - whole.spin.center->in_body_mm, left_out), kChi2Of3);
  for (const MotionSample& sample : half.samples) EXPECT_TRUE(sample.center);
}

TEST(AnalyseMotion, GapsAreFlagged) {
  MotionData data = Noisy(testing::FixedMotion());
  data.frames[10].pose.measured = false;
  data.frames[10].image_points.clear();
  const MotionAnalysis analysis = AnalyseMotion(data);
  EXPECT_EQ(analysis.samples[9].status, MotionStatus::kOk);
  EXPECT_EQ(analysis.samples[10].status, MotionStatus::kFilled);
  AnalyseOptions none;
  none.velocity.max_gap_s = 0;
  EXPECT_EQ(AnalyseMotion(data, none).samples[10].status, MotionStatus::kGap);
}

TEST(ThinRecording, StrideAndFrames) {
  EXPECT_EQ(JointFitStride(20, 20), 1U);
  EXPECT_EQ(JointFitStride(21, 20), 2U);
  EXPECT_EQ(JointFitStride(0, 0), 1U);
  MotionData data;
  data.frames.resize(7);
  for (std::size_t i = 0; i < 7; ++i) data.frames[i].pose.measured = i != 1;
  EXPECT_EQ(EveryNthPose(data, 2), (std::vector<std::size_t>{0, 3, 5}));
  EXPECT_EQ(FramesAt(data, {0, 3}).frames.size(), 2U);
  EXPECT_EQ(FirstPart(data, 2).frames.size(), 3U);
  EXPECT_TRUE(HasAllPoints(data));
  data.frames[0].image_points.emplace_back();
  EXPECT_FALSE(HasAllPoints(data));
}

// p + v τ + a τ²/2, its covariance by the same transition.
TEST(ThinRecording, StatesGoByTheirLaw) {
  CenterState state;
  state.position_mm = {1, 2, 3};
  state.velocity_mm_s = {10, 0, 0};
  state.acceleration_mm_s2 = {0, 8, 0};
  state.covariance.setIdentity();
  const CenterState moved = Propagated(state, 0.5);
  EXPECT_TRUE(moved.position_mm.isApprox(Eigen::Vector3d(6, 3, 3)));
  EXPECT_TRUE(moved.velocity_mm_s.isApprox(Eigen::Vector3d(10, 4, 0)));
  EXPECT_NEAR(moved.covariance(0, 0), 1 + 0.25 + 0.015625, 1e-12);
}

// n = 3 N − 3 − 3 residuals, a third of them along the arm: σ scatters by 1 / √(2 · N); 5 of that.
TEST(PoseNoise, IsThatOfSimulatedPoses) {
  auto rng = testing::MakeTestRng();
  constexpr std::size_t kPoses = 2000;
  constexpr double kSigma_rad = 0.002, kSigma_mm = 0.1;
  PoseSeries series(kPoses);
  const Eigen::Vector3d center_mm(150, 40, -20);
  for (std::size_t i = 0; i < kPoses; ++i) {
    const double s = static_cast<double>(i) / 100;
    PoseSample& pose = series[i];
    pose.timestamp_ns = static_cast<std::int64_t>(i) * 10'000'000;
    pose.measured = true;
    const Eigen::Quaterniond turn = ExpSO3({0.4 * std::sin(s), 0.3 * std::cos(1.3 * s), 0.1 * s});
    Vector6d noise = testing::NormalVector<6>(rng);
    noise.head<3>() *= kSigma_rad;
    noise.tail<3>() *= kSigma_mm;
    pose.world_from_body = Perturb({turn, -(turn * center_mm)}, noise);
  }
  const auto noise = EstimatePoseNoise(series);
  ASSERT_TRUE(noise);
  const double scatter = 5 / std::sqrt(2.0 * kPoses);
  EXPECT_NEAR(noise->translation_mm / kSigma_mm, 1, scatter);
  // The turn's part is a difference: across² − along², |c| σ_R = 0.31 mm, three times the other.
  EXPECT_NEAR(noise->rotation_rad / kSigma_rad, 1, 2 * scatter);
  GivePoseNoise(*noise, series);
  EXPECT_DOUBLE_EQ(series[5].covariance(4, 4), std::pow(noise->translation_mm, 2));
  EXPECT_THROW(GivePoseNoise({0, 1}, series), std::invalid_argument);
  series.resize(3);
  EXPECT_FALSE(EstimatePoseNoise(series));
}

MarkerSeries Cluster(std::size_t frames, double sigma_mm, std::mt19937_64& rng) {
  const std::vector<Eigen::Vector3d> shape_mm = {{0, 0, 0}, {80, 0, 5}, {0, 60, -9}, {30, 40, 70}};
  MarkerSeries markers{100, 7, {}};
  for (std::size_t i = 0; i < frames; ++i) {
    const double s = static_cast<double>(i) / 100;
    const Rigid3 pose{ExpSO3({s, 0.4 * std::sin(3 * s), 0.2}), {300 * s, 10, 20}};
    auto& points = markers.points_mm.emplace_back();
    for (const auto& point : shape_mm) {
      points.emplace_back(pose * point + sigma_mm * testing::NormalVector<3>(rng));
    }
  }
  return markers;
}

// 6 residuals a frame: σ scatters by 1 / √(12 N); 5 of that.
TEST(MarkerCluster, SigmaOfACoordinate) {
  auto rng = testing::MakeTestRng();
  constexpr std::size_t kFrames = 300;
  constexpr double kSigma_mm = 0.2;
  MarkerSeries markers = Cluster(kFrames, kSigma_mm, rng);
  markers.points_mm[3][1].setConstant(std::nan(""));
  for (auto& point : markers.points_mm[50]) point *= 1.1;  // no rigid motion
  const auto cluster = MakeCluster(markers);
  ASSERT_TRUE(cluster);
  EXPECT_NEAR(cluster->sigma_mm / kSigma_mm, 1, 5 / std::sqrt(12.0 * kFrames));
  EXPECT_EQ(cluster->not_rigid, 1);
  EXPECT_FALSE(cluster->data.frames[50].pose.measured);
  EXPECT_EQ(cluster->data.frames[3].space_points.size(), 3U);
  EXPECT_EQ(cluster->data.frames[0].pose.frame, 7);
  EXPECT_TRUE(cluster->data.frames[0].pose.world_from_body.rotation.isApprox(
      Eigen::Quaterniond::Identity(), 1e-9));
  EXPECT_EQ(MakeCluster(markers, 0.5)->sigma_mm, 0.5);
}

TEST(MarkerCluster, WhatIsNone) {
  auto rng = testing::MakeTestRng();
  MarkerSeries markers = Cluster(5, 0, rng);
  for (auto& frame : markers.points_mm) frame.resize(2);
  EXPECT_EQ(MakeCluster(markers).error(), ClusterFailure::kTooFewMarkers);
  markers = Cluster(1, 0, rng);
  EXPECT_EQ(MakeCluster(markers).error(), ClusterFailure::kTooFewFrames);
  markers = Cluster(5, 0, rng);
  for (auto& frame : markers.points_mm) frame = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {4, 0, 0}};
  EXPECT_EQ(MakeCluster(markers).error(), ClusterFailure::kTooFewMarkers);
  markers.rate_hz = 0;
  EXPECT_THROW(static_cast<void>(MakeCluster(markers)), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
