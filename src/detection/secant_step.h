#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace stereomotion {

/// Learns from a step how the likelihood bends along it, and corrects the next step for that.
///
/// Fisher's scoring steps by the expected information. In weak light the information observed may
/// be twice that in some direction: steps overshoot, swing to and fro and hardly converge.
/// Gradients at both ends of a step tell the curvature along it (the secant condition, Dennis &
/// Moré 1977).
template <int N>
class SecantStep {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  void Forget() { information_ = 0; }

  /// Takes note of a step, of the information expected and the gradient where it began, and of the
  /// gradient where it ended.
  void Learn(const Vector& step, const Matrix& information, const Vector& begin,
             const Vector& end) {
    step_ = step;
    information_ = step.dot(information * step);
    if (!(information_ > 0)) return Forget();
    curvature_ = step.dot(begin - end) / information_;
    curvature_ = std::clamp(curvature_, kLeastCurvature, kLargestCurvature);
  }

  /// Corrects a step of Fisher's scoring from the end of the last one, or from its begin.
  [[nodiscard]] Vector Correct(const Vector& step, const Vector& gradient) const {
    if (!(information_ > 0)) return step;
    return step + (1 / curvature_ - 1) * step_.dot(gradient) / information_ * step_;
  }

  /// Curvature along the last step as a multiple of the information expected.
  [[nodiscard]] double curvature() const { return curvature_; }

 private:
  /// Farther from 1 the step was too long for a parabola to tell.
  static constexpr double kLeastCurvature = 0.5, kLargestCurvature = 4;

  Vector step_ = Vector::Zero();
  double information_ = 0;  ///< along the step; 0: nothing is known
  double curvature_ = 1;
};

}  // namespace stereomotion
