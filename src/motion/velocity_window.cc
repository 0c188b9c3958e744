#include "motion/velocity_window.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

using Matrix12 = Eigen::Matrix<double, 12, 12>;

/// The squared bias is foretold as a mean over a neighbourhood. At the crest of a swing it is twice
/// the mean, and a mean of few windows is uncertain by half: so much is included in the covariance.
constexpr double kCrest = 3;
/// Squared bias (so enlarged) that a window may have, of the variance, in the direction where it is
/// worst. Being in the covariance it costs no coverage while it is foretold within a factor of two.
constexpr double kBiasShare = 0.5;
/// Degree 2 serves ω and v as degree 1, but α and a too; degree 4 lets the window grow where the
/// rate itself bends. Odd degrees have no less bias in a symmetrical window than the even one
/// below. Degree 6 is for motion so fast that degree 4 bends away within its own five poses.
constexpr int kDegrees[] = {1, 2, 4, 6};
/// The bias of degree 6 is extrapolated only: its window keeps to this share of the reach that χ²
/// allows, where the bias is 0.8^8 = a sixth of what χ² does not see; twice over if one-sided.
constexpr double kSexticShare = 0.8;
constexpr int kHalfWindows[] = {1, 2, 3, 4, 5, 6, 8, 10, 13, 16, 20, 25, 32, 40, 50, 64, 80, 100};

/// (ω, v, α, a) by the coefficients of order 0, 1, 2: ω = J_l(w) ẇ and its derivative, at the small
/// rotation w that the fit finds from the reference.
struct Kinematics {
  Eigen::Matrix<double, 12, 1> value = Eigen::Matrix<double, 12, 1>::Zero();
  Eigen::Matrix<double, 12, 18> jacobian = Eigen::Matrix<double, 12, 18>::Zero();
};

Kinematics KinematicsOf(const LocalPolynomial& fit, double unit_s) {
  Eigen::Matrix<double, 18, 1> c = Eigen::Matrix<double, 18, 1>::Zero();
  const Eigen::Index told = std::min<Eigen::Index>(18, fit.coefficients.size());
  c.head(told) = fit.coefficients.head(told);
  const double rate = 1 / unit_s;
  const Eigen::Vector3d w = c.segment<3>(0);
  const Eigen::Vector3d w1 = rate * c.segment<3>(6);
  const Eigen::Vector3d w2 = 2 * rate * rate * c.segment<3>(12);
  Kinematics k;
  k.value << w1 + w.cross(w1) / 2, rate * c.segment<3>(9),
      w2 + w.cross(w2) / 2 + w1.cross(w.cross(w1)) / 6, 2 * rate * rate * c.segment<3>(15);
  k.jacobian.block<3, 3>(0, 0) = -Hat(w1) / 2;
  k.jacobian.block<6, 6>(0, 6).diagonal().setConstant(rate);
  k.jacobian.block<3, 3>(6, 0) = -Hat(w2) / 2 - Hat(w1) * Hat(w1) / 6;
  k.jacobian.block<6, 6>(6, 12).diagonal().setConstant(2 * rate * rate);
  return k;
}

/// Holds one window's answer while windows are compared.
struct Candidate {
  BodyVelocity velocity;
  double bias_share = 0;  ///< worst over ω, v, α, a
  double spread = 0;      ///< log det of the covariance of (ω, v), bias included
};

double LargestShare(const Matrix12& bias, const Matrix12& noise, int blocks) {
  double largest = 0;
  for (int b = 0; b < blocks; ++b) {
    const Eigen::Matrix3d of_noise = noise.block<3, 3>(3 * b, 3 * b);
    const Eigen::Matrix3d of_bias = bias.block<3, 3>(3 * b, 3 * b);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> share(of_bias, of_noise,
                                                                          Eigen::EigenvaluesOnly);
    largest = std::max(largest, share.eigenvalues()[2]);
  }
  return largest;
}

Candidate Judge(const WindowMoments& window, int degree, const PathBend& bend) {
  const LocalPolynomial fit = FitLocalPolynomial(window, degree);
  const Kinematics kinematics = KinematicsOf(fit, window.stretch.unit_s);
  const Eigen::Index told = std::min<Eigen::Index>(18, fit.coefficients.size());
  const Eigen::MatrixXd jacobian = kinematics.jacobian.leftCols(told);
  const Matrix12 noise =
      bend.misfit * jacobian * fit.covariance.topLeftCorner(told, told) * jacobian.transpose();
  Matrix12 bias = Matrix12::Zero();
  for (int k = 0; k < kBiasOrders; ++k) {
    const Eigen::MatrixXd gain = jacobian * fit.bias_gains[k].topRows(told);
    bias += kCrest * gain * bend.moments[degree + 1 + k] * gain.transpose();
  }
  Candidate candidate;
  BodyVelocity& velocity = candidate.velocity;
  velocity.has_acceleration = degree >= 2;
  const int size = velocity.has_acceleration ? 12 : 6;
  velocity.omega_rad_s = kinematics.value.segment<3>(0);
  velocity.velocity_mm_s = kinematics.value.segment<3>(3);
  if (velocity.has_acceleration) {
    velocity.alpha_rad_s2 = kinematics.value.segment<3>(6);
    velocity.acceleration_mm_s2 = kinematics.value.segment<3>(9);
  }
  velocity.covariance.topLeftCorner(size, size) = (noise + bias).topLeftCorner(size, size);
  velocity.window = window.poses;
  velocity.degree = degree;
  candidate.bias_share = LargestShare(bias, noise, size / 3);
  const Matrix6d first = velocity.covariance.topLeftCorner<6, 6>();
  candidate.spread = first.llt().matrixLLT().diagonal().array().log().sum();
  return candidate;
}

/// Tells whether `a` is to be preferred: little bias first, then little spread.
bool Better(const Candidate& a, const Candidate& b) {
  const bool a_fair = a.bias_share <= kBiasShare, b_fair = b.bias_share <= kBiasShare;
  if (a_fair != b_fair) return a_fair;
  return a.spread < b.spread;
}

/// Most poses in a window of a degree: as many as a symmetrical one of the pilots' reach has, also
/// where the window is one-sided. About a gap (where it is even) it must hold the degree too.
int ReachOf(int degree, const PathBend& bend, bool one_sided, bool measured) {
  int half = degree <= 2 ? bend.quartic_reach : bend.sextic_reach;
  if (degree > 4) half = static_cast<int>(kSexticShare * (one_sided ? kSexticShare : 1) * half);
  return 2 * std::max(half, std::max(degree / 2, 1)) + (measured ? 1 : 2);
}

/// Pose at a time inside a stretch: measured, or interpolated where a gap is filled.
Rigid3 ReferenceAt(const PoseStretch& stretch, double time_s, std::size_t after) {
  if (stretch.times_s[after] == time_s) return stretch.poses[after];
  const double share =
      (time_s - stretch.times_s[after - 1]) / (stretch.times_s[after] - stretch.times_s[after - 1]);
  return Perturb(stretch.poses[after - 1],
                 share * PerturbationBetween(stretch.poses[after - 1], stretch.poses[after]));
}

}  // namespace

BodyVelocity VelocityAt(const PoseStretch& stretch, const PathRoughness& roughness, double time_s,
                        int max_half_window) {
  const auto& times = stretch.times_s;
  const std::size_t after = std::lower_bound(times.begin(), times.end(), time_s) - times.begin();
  const PathBend bend = roughness.Near(after);
  WindowMoments window(stretch, time_s, ReferenceAt(stretch, time_s, after));
  std::size_t low = after, high = after;  // poses [low, high) are in the window
  bool more_low = true, more_high = true;
  std::optional<Candidate> best;
  for (const int half : kHalfWindows) {
    const bool measured = times[after] == time_s;
    const std::size_t first = after - std::min<std::size_t>(after, half);
    const std::size_t end = std::min(times.size(), after + half + (measured ? 1 : 0));
    for (; more_high && high < end; ++high) {
      if (!(more_high = window.Add(high))) break;
    }
    for (; more_low && low > first; --low) {
      if (!(more_low = window.Add(low - 1))) break;
    }
    const bool one_sided = high - after != after - low + (measured ? 1 : 0);
    for (const int degree : kDegrees) {
      const int reach = ReachOf(degree, bend, one_sided, measured);
      if (window.poses <= degree || (best && window.poses > reach)) continue;
      const Candidate candidate = Judge(window, degree, bend);
      if (!best || Better(candidate, *best)) best = candidate;
    }
    if (half >= max_half_window ||
        (best && window.poses > 2 * std::max(bend.quartic_reach, bend.sextic_reach))) {
      break;
    }
  }
  return best ? best->velocity : BodyVelocity{};
}

}  // namespace stereomotion
