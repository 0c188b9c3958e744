#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "stereomotion/geometry/so3.h"
#include "stereomotion/motion/velocity.h"
#include "tests/support/ktk_markers.h"

// Marker files as other programs write them (real/clusters_ktk): an N3D file of an Optotrak, with
// markers at rest and a probe of which some markers vanish at times; and a tennis serve, smooth and
// fast, in metres, without gaps: they are cut into it.

namespace stereomotion::testing {
namespace {

using Labels = std::vector<std::string>;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

MarkerSeries Head() {
  return PickMarkers(ReadKtk("kinematics_tennis_serve.c3d"),
                     {"Derrick:LFHD", "Derrick:RFHD", "Derrick:LBHD", "Derrick:RBHD"});
}

void Hide(std::size_t marker, std::size_t first, std::size_t count, MarkerSeries& markers) {
  for (std::size_t t = first; t < first + count; ++t) {
    markers.points_mm[t][marker].setConstant(kNaN);
  }
}

/// White noise of a coordinate: of a motion that is smooth over four frames, the third differences
/// keep nothing else (variance 1 + 9 + 9 + 1 times that of a place).
double Jitter_mm(const MarkerSeries& markers) {
  constexpr double kVarianceOfThirdDifference = 20;
  const auto& p = markers.points_mm;
  double sum = 0;
  int count = 0;
  for (std::size_t t = 3; t < p.size(); ++t) {
    for (std::size_t i = 0; i < p[t].size(); ++i) {
      const Eigen::Vector3d d = p[t][i] - 3 * p[t - 1][i] + 3 * p[t - 2][i] - p[t - 3][i];
      if (!d.allFinite()) continue;
      sum += d.squaredNorm() / kVarianceOfThirdDifference;
      count += 3;
    }
  }
  return std::sqrt(sum / count);
}

/// Spread of a coordinate about its mean, of markers that are seen in all frames.
double Scatter_mm(const MarkerSeries& markers) {
  const std::size_t count = markers.points_mm.front().size(), frames = markers.points_mm.size();
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d mean_mm = Eigen::Vector3d::Zero();
    for (const auto& frame : markers.points_mm) mean_mm += frame[i] / static_cast<double>(frames);
    for (const auto& frame : markers.points_mm) sum += (frame[i] - mean_mm).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(3 * count * (frames - 1)));
}

TEST(MotionMarkers, SigmaOfRestingClustersLiesBetweenJitterAndScatter) {
  const C3dPoints points = ReadKtk("kinematics_sample_optotrak.n3d");
  ASSERT_EQ(points.points_mm.size(), 140U);
  const std::vector<Labels> clusters = {{"point19", "point20", "point21", "point22"},
                                        {"point13", "point14", "point15"},
                                        {"point28", "point29", "point30"},
                                        {"point32", "point33", "point34"},
                                        {"point10", "point11", "point12"},
                                        {"point35", "point36", "point37"}};
  for (const Labels& labels : clusters) {
    const MarkerSeries markers = PickMarkers(points, labels);
    const auto cluster = MakeCluster(markers);
    ASSERT_TRUE(cluster) << labels.front();
    fmt::print("{}: jitter {:.4f}, σ {:.4f}, scatter {:.4f} mm\n", labels.front(),
               Jitter_mm(markers), cluster->sigma_mm, Scatter_mm(markers));
    // The rigid fit takes out what all markers share, as sway; the differences also what is slow.
    EXPECT_GT(cluster->sigma_mm, Jitter_mm(markers)) << labels.front();
    EXPECT_LT(cluster->sigma_mm, Scatter_mm(markers)) << labels.front();
  }
}

TEST(MotionMarkers, ProbeThatLosesMarkersKeepsItsPose) {
  const C3dPoints points = ReadKtk("kinematics_sample_optotrak.n3d");
  const MarkerSeries probe =
      PickMarkers(points, {"point1", "point2", "point3", "point4", "point5", "point6"});
  const auto cluster = MakeCluster(probe);
  ASSERT_TRUE(cluster);
  EXPECT_EQ(cluster->data.balls_in_body_mm.size(), 5U);  // the sixth is never seen
  int with_gaps = 0;
  double whole_rad2 = 0, least_rad2 = 1;  // variance of the rotation: with five markers, with less
  for (const MotionFrame& frame : cluster->data.frames) {
    EXPECT_TRUE(frame.pose.measured) << frame.pose.frame;
    const double variance_rad2 = frame.pose.covariance.topLeftCorner<3, 3>().trace();
    const bool is_whole = frame.space_points.size() == 5;
    with_gaps += is_whole ? 0 : 1;
    if (is_whole) whole_rad2 = std::max(whole_rad2, variance_rad2);
    if (!is_whole) least_rad2 = std::min(least_rad2, variance_rad2);
  }
  EXPECT_LT(whole_rad2, least_rad2);
  EXPECT_EQ(with_gaps, 2 + 12);  // of the fourth and the fifth marker, as the file has it
}

/// A hidden marker's place as the others tell it, against where it was seen.
struct HiddenScore {
  double nees_dof = 0;
  double widest = 0;  ///< largest variance that was stated for the difference, in σ²
};

HiddenScore ScoreHidden(const MarkerSeries& seen, std::size_t hidden, double sigma_mm) {
  MarkerSeries markers = seen;
  for (std::size_t t = 0; t < markers.points_mm.size(); t += 2) Hide(hidden, t, 1, markers);
  const auto cluster = MakeCluster(markers, sigma_mm);
  const Eigen::Vector3d& p_in_body_mm = cluster->data.balls_in_body_mm[hidden];
  const double variance_mm2 = sigma_mm * sigma_mm;
  HiddenScore score;
  int count = 0;
  for (std::size_t t = 0; t < markers.points_mm.size(); t += 2) {
    const PoseSample& pose = cluster->data.frames[t].pose;
    if (!pose.measured) continue;
    const Eigen::Vector3d off_mm = seen.points_mm[t][hidden] - pose.world_from_body * p_in_body_mm;
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian << -Hat(pose.world_from_body.rotation * p_in_body_mm), Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d covariance_mm2 = jacobian * pose.covariance * jacobian.transpose() +
                                           variance_mm2 * Eigen::Matrix3d::Identity();
    score.nees_dof += off_mm.dot(covariance_mm2.llt().solve(off_mm)) / 3;
    score.widest = std::max(
        score.widest, covariance_mm2.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff());
    ++count;
  }
  score.nees_dof /= count;
  score.widest /= variance_mm2;
  return score;
}

TEST(MotionMarkers, HiddenMarkerLiesWhereTheOthersSayWithinTheirUncertainty) {
  const MarkerSeries head = Head();
  const auto cluster = MakeCluster(head);
  ASSERT_TRUE(cluster);
  fmt::print("head: σ {:.3f}, jitter {:.3f} mm, {} frames left out as not rigid\n",
             cluster->sigma_mm, Jitter_mm(head), cluster->not_rigid);
  double mean = 0, widest = 0;
  for (std::size_t marker = 0; marker < 4; ++marker) {
    const HiddenScore score = ScoreHidden(head, marker, cluster->sigma_mm);
    fmt::print("marker {} hidden: NEES/dof {:.2f}, {:.1f} σ²\n", marker, score.nees_dof,
               score.widest);
    mean += score.nees_dof / 4;
    widest = std::max(widest, score.widest);
  }
  // The left-out difference is (1 − h)⁻¹ times the residual of the whole fit, with the variance
  // σ²/(1 − h) (Cook & Weisberg 1982). The residuals' squares add up to the degrees of freedom, 6
  // of 12 numbers a frame, whatever the errors are: so the mean of NEES/dof lies between 1/2 of the
  // least and of the largest 1/(1 − h), and at 1 where all markers err alike.
  constexpr double kDofShare = 0.5;
  EXPECT_GT(mean, kDofShare);
  EXPECT_LT(mean, kDofShare * widest);
}

/// With fewer data and with all: the variance of the difference is the one of fewer less the one of
/// all (Hausman 1978), so at most the former.
double NeesOfVelocity(const BodyVelocity& fewer, const BodyVelocity& all) {
  Vector6d difference;
  difference << fewer.omega_rad_s - all.omega_rad_s, fewer.velocity_mm_s - all.velocity_mm_s;
  const Matrix6d covariance = fewer.covariance.topLeftCorner<6, 6>();
  return difference.dot(covariance.llt().solve(difference));
}

TEST(MotionMarkers, GapsOfTheServeAreFilledWhenShortAndLeftEmptyWhenLong) {
  MarkerSeries head = Head();
  const auto whole = MakeCluster(head);
  ASSERT_TRUE(whole);
  constexpr double kChi2Of999 = 22.46;  // six degrees of freedom
  // Of two markers no pose is known. 50 frames a second: 60 ms from pose to pose, and 420.
  constexpr std::size_t kShort = 300, kShortCount = 2, kLong = 600, kLongCount = 20;
  for (const std::size_t marker : {0U, 1U}) {
    Hide(marker, kShort, kShortCount, head);
    Hide(marker, kLong, kLongCount, head);
  }
  const auto cluster = MakeCluster(head, whole->sigma_mm);
  ASSERT_TRUE(cluster);
  const auto all = EstimateVelocities(PosesOf(whole->data));
  const auto velocities = EstimateVelocities(PosesOf(cluster->data));
  ASSERT_EQ(velocities.size(), 1092U);
  for (std::size_t t = kShort; t < kShort + kShortCount; ++t) {
    EXPECT_FALSE(cluster->data.frames[t].pose.measured);
    EXPECT_EQ(velocities[t].status, MotionStatus::kFilled) << t;
    const double nees = NeesOfVelocity(velocities[t], all[t]);
    fmt::print("frame {}: NEES {:.2f} of 6\n", t, nees);
    EXPECT_LT(nees, kChi2Of999);
  }
  for (std::size_t t = kLong + 1; t + 1 < kLong + kLongCount; ++t) {
    EXPECT_EQ(velocities[t].status, MotionStatus::kGap) << t;
  }
}

}  // namespace
}  // namespace stereomotion::testing
