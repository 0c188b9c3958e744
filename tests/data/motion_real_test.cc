#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "stereomotion/motion/spin_center.h"
#include "tests/support/number_table.h"
#include "tests/support/recording_run.h"

// A pointer that pivots on its tip, followed by an optical tracker (real/pivot_ucl): 57 poses, one
// a second, without uncertainties. The peer is scikit-surgerycalibration's plain least squares.

namespace stereomotion::testing {
namespace {

/// What the peer prints, to its digits.
const Eigen::Vector3d kPeerTip_mm(-14.473, 394.634, -7.407);
const Eigen::Vector3d kPeerPivot_mm(-804.742, -85.474, -2112.131);
constexpr double kPeerResidual_mm = 1.761, kHalfDigit_mm = 0.0005;

std::vector<Rigid3> ReadPoses() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(SharedData() / "real/pivot_ucl")) {
    if (entry.path().extension() == ".txt") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());  // their names are times, all of one length
  std::vector<Rigid3> poses;
  for (const auto& file : files) {
    const auto rows = ReadNumbers(file);
    Eigen::Matrix3d rotation;
    Rigid3 pose;
    for (int i = 0; i < 3; ++i) {
      const std::vector<double>& row = rows.at(static_cast<std::size_t>(i));
      rotation.row(i) << row.at(0), row.at(1), row.at(2);
      pose.translation_mm[i] = row.at(3);
    }
    pose.rotation = Eigen::Quaterniond(rotation).normalized();
    poses.push_back(pose);
  }
  return poses;
}

/// The peer's method: R c + t = p by linear least squares.
struct PlainPivot {
  Eigen::Vector3d tip_mm, pivot_mm;
  double residual_mm = 0;                   ///< RMS of a coordinate
  std::vector<Eigen::Vector3d> in_body_mm;  ///< residuals of the frames, in body axes
};

PlainPivot FitPlainPivot(const std::vector<Rigid3>& poses) {
  const auto rows = 3 * static_cast<Eigen::Index>(poses.size());
  Eigen::MatrixXd matrix(rows, 6);
  Eigen::VectorXd right(rows);
  for (std::size_t t = 0; t < poses.size(); ++t) {
    const auto row = 3 * static_cast<Eigen::Index>(t);
    matrix.block<3, 3>(row, 0) = poses[t].rotation.toRotationMatrix();
    matrix.block<3, 3>(row, 3) = -Eigen::Matrix3d::Identity();
    right.segment<3>(row) = -poses[t].translation_mm;
  }
  const Eigen::VectorXd solution = matrix.colPivHouseholderQr().solve(right);
  const Eigen::VectorXd residuals = matrix * solution - right;
  PlainPivot fit{solution.head<3>(),
                 solution.tail<3>(),
                 std::sqrt(residuals.squaredNorm() / static_cast<double>(rows)),
                 {}};
  for (std::size_t t = 0; t < poses.size(); ++t) {
    fit.in_body_mm.push_back(poses[t].rotation.conjugate() *
                             Eigen::Vector3d(residuals.segment<3>(3 * static_cast<int>(t))));
  }
  return fit;
}

/// The tracker's noise as the residuals of the plain fit show it: those along the pointer come from
/// the places alone, those across it from the rotations, by the pointer's length. Medians, for a
/// few frames are far off.
struct TrackerNoise {
  double rotation_rad = 0, translation_mm = 0;
};

double RobustSigma(std::vector<double> values) {
  constexpr double kSigmaPerMedian = 1.4826;  // of a normal distribution
  for (double& value : values) value = std::abs(value);
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                   values.end());
  return kSigmaPerMedian * values[values.size() / 2];
}

TrackerNoise NoiseOf(const PlainPivot& fit) {
  const Eigen::Vector3d along = fit.tip_mm.normalized(), side = along.unitOrthogonal();
  std::vector<double> along_mm, across_mm;
  for (const Eigen::Vector3d& residual_mm : fit.in_body_mm) {
    along_mm.push_back(residual_mm.dot(along));
    across_mm.push_back(residual_mm.dot(side));
    across_mm.push_back(residual_mm.dot(along.cross(side)));
  }
  TrackerNoise noise;
  noise.translation_mm = RobustSigma(along_mm);
  const double across = RobustSigma(across_mm);
  noise.rotation_rad =
      std::sqrt(across * across - noise.translation_mm * noise.translation_mm) / fit.tip_mm.norm();
  return noise;
}

/// Every `stride`th pose from `first` on.
MotionData DataOf(const std::vector<Rigid3>& poses, const TrackerNoise& noise,
                  std::size_t first = 0, std::size_t stride = 1) {
  constexpr std::int64_t kPeriod_ns = 1'000'000'000;
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(noise.rotation_rad * noise.rotation_rad),
      Eigen::Vector3d::Constant(noise.translation_mm * noise.translation_mm);
  MotionData data;
  for (std::size_t t = first; t < poses.size(); t += stride) {
    PoseSample& pose = data.frames.emplace_back().pose;
    pose.frame = static_cast<std::int64_t>(t);
    pose.timestamp_ns = pose.frame * kPeriod_ns;
    pose.measured = true;
    pose.world_from_body = poses[t];
    pose.covariance = variances.asDiagonal();
  }
  return data;
}

SpinCenterResult FindPivot(const MotionData& data) {
  SpinCenterOptions options;
  options.law = PathLaw::kFixed;
  return FindSpinCenter(data, options);
}

const LawFit& FixedFit(const SpinCenterResult& found) {
  return *std::find_if(found.laws.begin(), found.laws.end(),
                       [](const LawFit& fit) { return fit.law == PathLaw::kFixed; });
}

/// Variances are multiplied by χ²/dof: the poses bring none of their own.
double NoiseScale(const SpinCenterResult& found) {
  return FixedFit(found).chi2 / FixedFit(found).dof;
}

TEST(MotionReal, PeersPivotIsReproducedToItsDigits) {
  const PlainPivot fit = FitPlainPivot(ReadPoses());
  EXPECT_LT((fit.tip_mm - kPeerTip_mm).cwiseAbs().maxCoeff(), kHalfDigit_mm);
  EXPECT_LT((fit.pivot_mm - kPeerPivot_mm).cwiseAbs().maxCoeff(), kHalfDigit_mm);
  EXPECT_NEAR(fit.residual_mm, kPeerResidual_mm, kHalfDigit_mm);
}

TEST(MotionReal, PivotAgreesWithThePeerWithinItsUncertainty) {
  const std::vector<Rigid3> poses = ReadPoses();
  ASSERT_EQ(poses.size(), 57U);
  const PlainPivot plain = FitPlainPivot(poses);
  const TrackerNoise noise = NoiseOf(plain);
  const SpinCenterResult found = FindPivot(DataOf(poses, noise));
  ASSERT_TRUE(found.center);
  EXPECT_FALSE(found.center->free_axis_in_body);
  const Eigen::Vector3d u_mm =
      (NoiseScale(found) * found.center->covariance_mm2.diagonal()).cwiseSqrt();
  const Eigen::Vector3d& tip_mm = found.center->in_body_mm;
  fmt::print(
      "noise {:.2f} mrad, {:.2f} mm; tip {:.3f} {:.3f} {:.3f} ± {:.3f} {:.3f} {:.3f} mm, "
      "χ²/dof {:.2f}, left out {}; {}\n",
      1e3 * noise.rotation_rad, noise.translation_mm, tip_mm.x(), tip_mm.y(), tip_mm.z(), u_mm.x(),
      u_mm.y(), u_mm.z(), NoiseScale(found), found.left_out.size(), found.verdict);
  // By theory the plain fit is worse than ours by at most its own uncertainty, which stands in for
  // that of the difference (Hausman 1978): σ of a tip's coordinate by its residuals is 1.1 mm.
  constexpr double kPlainSigma_mm = 1.15, kSigmas = 3.3;
  EXPECT_LT((tip_mm - kPeerTip_mm).cwiseAbs().maxCoeff(), kSigmas * kPlainSigma_mm);
  EXPECT_LT(u_mm.maxCoeff(), kPlainSigma_mm);
}

TEST(MotionReal, HalvesOfThePivotAgreeWithinTheirUncertainties) {
  const std::vector<Rigid3> poses = ReadPoses();
  const TrackerNoise noise = NoiseOf(FitPlainPivot(poses));
  const SpinCenterResult even = FindPivot(DataOf(poses, noise, 0, 2));
  const SpinCenterResult odd = FindPivot(DataOf(poses, noise, 1, 2));
  ASSERT_TRUE(even.center && odd.center);
  const Eigen::Vector3d apart_mm = even.center->in_body_mm - odd.center->in_body_mm;
  const Eigen::Matrix3d covariance_mm2 =
      NoiseScale(even) * even.center->covariance_mm2 + NoiseScale(odd) * odd.center->covariance_mm2;
  const double nees = apart_mm.dot(covariance_mm2.llt().solve(apart_mm));
  fmt::print("halves: {:.2f} {:.2f} {:.2f} mm apart, NEES {:.2f} of 3\n", apart_mm.x(),
             apart_mm.y(), apart_mm.z(), nees);
  constexpr double kChi2Of999 = 16.27;  // three degrees of freedom
  EXPECT_LT(nees, kChi2Of999);
}

}  // namespace
}  // namespace stereomotion::testing
