#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "stereomotion/motion/joint.h"
#include "tests/support/ktk_markers.h"

// Marker clusters that an Optotrak followed (real/clusters_ktk, Kinetics Toolkit): a probe whose
// geometry is given, and the right arm of a wheelchair racer. No wheel carries markers there.

namespace stereomotion::testing {
namespace {

using Labels = std::vector<std::string>;

C3dPoints ReadRacing(const std::string& name) {
  return ReadKtk("kinematics_racing_" + name + ".c3d");
}

MarkerSeries PickProbe(const C3dPoints& points) {
  return PickMarkers(points, {"Probe1", "Probe2", "Probe3", "Probe4", "Probe5", "Probe6"});
}

/// The peer's file of the probe; its tip is the origin.
Eigen::Matrix3Xd GivenProbe_mm() {
  Eigen::Matrix3Xd probe(3, 6);
  probe << 2.1213, 2.1213, 2.0575, 2.1213, 1.7070, 1.7762,      //
      -15.8328, 15.8508, 16.0096, 16.1204, -15.5780, -15.6057,  //
      86.4285, 86.4285, 130.9445, 175.4395, 175.3805, 130.8888;
  return probe;
}

Eigen::Matrix3Xd Matrix(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Matrix3Xd matrix(3, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) matrix.col(static_cast<int>(i)) = points[i];
  return matrix;
}

/// RMS distance of the markers from a shape that is aligned in every frame that shows all of them.
double RigidRms_mm(const MarkerSeries& markers, const Eigen::Matrix3Xd& shape_mm) {
  double sum = 0;
  int count = 0;
  for (const std::vector<Eigen::Vector3d>& frame : markers.points_mm) {
    const Eigen::Matrix3Xd seen_mm = Matrix(frame);
    if (!seen_mm.allFinite()) continue;
    const Rigid3 world_from_shape = AlignPoints(shape_mm, seen_mm);
    for (int i = 0; i < seen_mm.cols(); ++i) {
      sum += (seen_mm.col(i) - world_from_shape * Eigen::Vector3d(shape_mm.col(i))).squaredNorm();
      ++count;
    }
  }
  return std::sqrt(sum / count);
}

const Labels kProbings = {"probing_acromion_R", "probing_medial_epicondyle_R", "probing_olecrane_R",
                          "probing_radial_styloid_R", "probing_ulnar_styloid_R"};

TEST(MotionClusters, ProbeFitsItsGivenGeometry) {
  // 0.07–0.18 mm by the peer, more or less by a digit for the frames in which a marker lacks.
  constexpr double kLeast_mm = 0.065, kMost_mm = 0.19;
  for (const std::string& name : kProbings) {
    const double rms_mm = RigidRms_mm(PickProbe(ReadRacing(name)), GivenProbe_mm());
    fmt::print("{}: {:.3f} mm\n", name, rms_mm);
    EXPECT_GT(rms_mm, kLeast_mm) << name;
    EXPECT_LT(rms_mm, kMost_mm) << name;
  }
}

TEST(MotionClusters, LearnedProbeFitsBetterThanTheGivenOne) {
  for (const std::string& name : kProbings) {
    const MarkerSeries probe = PickProbe(ReadRacing(name));
    const auto cluster = MakeCluster(probe);
    ASSERT_TRUE(cluster) << name;
    const Eigen::Matrix3Xd learned_mm = Matrix(cluster->data.balls_in_body_mm);
    const double given_rms_mm = RigidRms_mm(probe, GivenProbe_mm());
    const double learned_rms_mm = RigidRms_mm(probe, learned_mm);
    // The mean shape is the least-squares one, and differs from the given one by no more than what
    // that one's residuals are.
    EXPECT_LT(learned_rms_mm, given_rms_mm) << name;
    const Rigid3 given_from_learned = AlignPoints(learned_mm, GivenProbe_mm());
    double apart = 0;
    for (int i = 0; i < learned_mm.cols(); ++i) {
      apart += (given_from_learned * Eigen::Vector3d(learned_mm.col(i)) - GivenProbe_mm().col(i))
                   .squaredNorm();
    }
    apart = std::sqrt(apart / static_cast<double>(learned_mm.cols()));
    fmt::print("{}: given {:.3f}, learned {:.3f}, shapes {:.3f} mm apart; σ {:.3f} mm\n", name,
               given_rms_mm, learned_rms_mm, apart, cluster->sigma_mm);
    EXPECT_LT(apart, given_rms_mm) << name;
  }
}

Eigen::Vector3d MeanInBody_mm(const MarkerSeries& marker, const PoseSeries& poses) {
  Eigen::Vector3d sum_mm = Eigen::Vector3d::Zero();
  int count = 0;
  for (std::size_t t = 0; t < poses.size(); ++t) {
    const Eigen::Vector3d& seen_mm = marker.points_mm[t].front();
    if (!poses[t].measured || !seen_mm.allFinite()) continue;
    sum_mm += poses[t].world_from_body.Inverse() * seen_mm;
    ++count;
  }
  return sum_mm / count;
}

TEST(MotionClusters, ElbowLiesBetweenTheEpicondyles) {
  const C3dPoints points = ReadRacing("full");
  const auto arm = MakeCluster(PickMarkers(points, {"ArmR1", "ArmR2", "ArmR3"}));
  const auto forearm = MakeCluster(PickMarkers(points, {"ForearmR1", "ForearmR2", "ForearmR3"}));
  ASSERT_TRUE(arm && forearm);
  const PoseSeries arm_poses = PosesOf(arm->data);
  const auto elbow = FindJoint(arm_poses, PosesOf(forearm->data));
  ASSERT_TRUE(elbow);
  const Eigen::Vector3d lateral_mm =
      MeanInBody_mm(PickMarkers(points, {"LateralEpicondyleR"}), arm_poses);
  const Eigen::Vector3d medial_mm =
      MeanInBody_mm(PickMarkers(points, {"MedialEpicondyleR"}), arm_poses);
  const double width_mm = (lateral_mm - medial_mm).norm();
  const Eigen::Vector3d off_mm = elbow->center_in_first_mm - (lateral_mm + medial_mm) / 2;
  fmt::print(
      "elbow {:.1f} mm from the middle of the epicondyles, which are {:.1f} mm apart; "
      "centres agree to {:.1f} mm RMS, axes to {:.1f}°; {}\n",
      off_mm.norm(), width_mm, elbow->rms_mm, 57.2958 * elbow->axis_dispersion_rad, elbow->verdict);
  // Anatomy: the centre lies inside the joint.
  EXPECT_LT(off_mm.norm(), width_mm / 2);
}

}  // namespace
}  // namespace stereomotion::testing
