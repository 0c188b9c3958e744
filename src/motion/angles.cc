#include <Eigen/LU>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "stereomotion/motion/frames_of_reference.h"

namespace stereomotion {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Holds a sequence as axis numbers of an intrinsic one (an extrinsic one is that, backwards).
struct Axes {
  int i = 0, j = 0, k = 0;
  bool extrinsic = false;
  [[nodiscard]] bool euler() const { return i == k; }
  /// The axis that is neither the first nor the second.
  [[nodiscard]] int other() const { return 3 - i - j; }
  /// +1 where first, second and other axis follow each other cyclically.
  [[nodiscard]] double parity() const { return (j - i + 3) % 3 == 1 ? 1 : -1; }
};

Axes AxesOf(const AngleSequence& sequence) {
  const std::string axes = AngleSequence::Parse(sequence.axes).axes;
  const auto number = [&](int at) {
    return std::tolower(static_cast<unsigned char>(axes[static_cast<std::size_t>(at)])) - 'x';
  };
  const bool extrinsic = std::isupper(static_cast<unsigned char>(axes[0])) != 0;
  return {number(extrinsic ? 2 : 0), number(1), number(extrinsic ? 0 : 2), extrinsic};
}

/// Finds the triple in the principal range; of R = R_i(a) R_j(b) R_k(c).
Eigen::Vector3d PrincipalAngles(const Eigen::Matrix3d& r, const Axes& axes) {
  const int i = axes.i, j = axes.j, k = axes.other();
  const double e = axes.parity();
  if (axes.euler()) {
    return {std::atan2(r(j, i), -e * r(k, i)), std::atan2(std::hypot(r(i, j), r(i, k)), r(i, i)),
            std::atan2(r(i, j), e * r(i, k))};
  }
  return {std::atan2(-e * r(j, k), r(k, k)), std::atan2(e * r(i, k), std::hypot(r(i, i), r(i, j))),
          std::atan2(-e * r(i, j), r(i, i))};
}

/// Chooses among all triples of the same rotation the one nearest to another triple.
Eigen::Vector3d NearestAngles(const Eigen::Vector3d& angles, const Axes& axes,
                              const Eigen::Vector3d& to) {
  const Eigen::Vector3d twin(angles[0] + kPi, (axes.euler() ? 0 : kPi) - angles[1],
                             angles[2] + kPi);
  const auto unwrap = [&](const Eigen::Vector3d& triple) -> Eigen::Vector3d {
    return triple + 2 * kPi * ((to - triple) / (2 * kPi)).array().round().matrix();
  };
  const Eigen::Vector3d a = unwrap(angles), b = unwrap(twin);
  return (a - to).squaredNorm() <= (b - to).squaredNorm() ? a : b;
}

/// Differentiates the rotation's perturbation (base axes) by the three angles.
Eigen::Matrix3d PerturbationByAngles(const Eigen::Vector3d& angles, const Axes& axes) {
  const auto unit = [](int axis) { return Eigen::Vector3d::Unit(axis); };
  const Eigen::AngleAxisd first(angles[0], unit(axes.i)), second(angles[1], unit(axes.j));
  Eigen::Matrix3d jacobian;
  jacobian << unit(axes.i), first * unit(axes.j), first * (second * unit(axes.k));
  return jacobian;
}

/// Tells how far the middle angle is from gimbal lock: |cos b| or |sin b|, 0 … 1.
double LockDistance(double middle, const Axes& axes) {
  return std::abs(axes.euler() ? std::sin(middle) : std::cos(middle));
}

/// Fills in the covariance, or declares the pose locked.
void Propagate(const Matrix6d& pose_covariance, const Axes& axes, PoseAngles& out) {
  constexpr double kLargestSigma = 1.0 / 3;  // rad: a third of the distance to the lock
  const Eigen::Matrix3d by_angles = PerturbationByAngles(out.angles_rad, axes);
  const Eigen::Matrix3d c = pose_covariance.topLeftCorner<3, 3>();
  const double distance = LockDistance(out.angles_rad[1], axes);
  // The middle angle's gradient is its axis at any distance from the lock, so its variance holds.
  const Eigen::Vector3d middle_axis = by_angles.col(1);
  const double middle_variance = middle_axis.dot(c * middle_axis);
  out.covariance_rad2.setZero();
  out.covariance_rad2(1, 1) = middle_variance;
  constexpr double kSingular = 1e-12;  // where inverting loses all digits
  out.locked = distance < kSingular || std::sqrt(middle_variance) > kLargestSigma * distance;
  if (out.locked) return;
  const Eigen::Matrix3d jacobian = by_angles.inverse();
  const Eigen::Matrix3d covariance = jacobian * c * jacobian.transpose();
  const double worst = std::sqrt(std::max(covariance(0, 0), covariance(2, 2)));
  out.locked = worst > kLargestSigma;
  if (!out.locked) out.covariance_rad2 = covariance;
}

/// Turns the angles of the intrinsic twin into those of an extrinsic sequence.
PoseAngles InOrder(PoseAngles angles, const Axes& axes) {
  if (!axes.extrinsic) return angles;
  std::swap(angles.angles_rad[0], angles.angles_rad[2]);
  angles.covariance_rad2 = angles.covariance_rad2.reverse().eval();
  return angles;
}

}  // namespace

AngleSequence AngleSequence::Parse(std::string_view text) {
  const auto fits = [&](char low) {
    return text.size() == 3 && text[0] != text[1] && text[1] != text[2] &&
           std::all_of(text.begin(), text.end(), [&](char c) { return c >= low && c <= low + 2; });
  };
  if (!fits('x') && !fits('X')) {
    throw std::invalid_argument("angle sequence \"" + std::string(text) +
                                "\": expected three axes like zxy (about the turned axes) or ZXY "
                                "(about the fixed ones), neighbours different");
  }
  return {std::string(text)};
}

std::vector<PoseAngles> AnglesOf(const PoseSeries& series, const AngleSequence& sequence) {
  const Axes axes = AxesOf(sequence);
  std::vector<PoseAngles> out;
  std::optional<Eigen::Vector3d> last;
  for (const PoseSample& sample : series) {
    PoseAngles angles;
    angles.measured = sample.measured && !sample.free_axis_in_world;
    if (angles.measured) {
      angles.angles_rad =
          PrincipalAngles(sample.world_from_body.rotation.normalized().toRotationMatrix(), axes);
      if (last) angles.angles_rad = NearestAngles(angles.angles_rad, axes, *last);
      Propagate(sample.covariance, axes, angles);
      if (!angles.locked) last = angles.angles_rad;
    }
    out.push_back(InOrder(angles, axes));
  }
  return out;
}

}  // namespace stereomotion
