#pragma once

#include <Eigen/Core>
#include <vector>

#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Holds power spectral densities of the noise that drives ω and v (white acceleration).
struct MotionNoise {
  double rotation_rad2_s3 = 0, translation_mm2_s3 = 0;
};

/// Holds pose and rate of a body with the covariance of their perturbation (δθ, δt, δω, δv), world
/// axes, left perturbation.
struct MotionState {
  using Covariance = Eigen::Matrix<double, 12, 12>;
  Rigid3 world_from_body;
  Eigen::Vector3d omega_rad_s, velocity_mm_s;
  Covariance covariance;
};

/// Runs the error-state Kalman filter forward over samples [first, last] of a series and the
/// smoother of Rauch, Tung and Striebel (1965) backward. Between samples R⁺ = Exp(ω dt) R,
/// t⁺ = t + v dt; ω and v take random steps. The rates start unknown (a variance beyond all that
/// the data allows); samples that are not measured are predicted over.
/// Series[first] must be measured.
std::vector<MotionState> SmoothSegment(const PoseSeries& series, std::size_t first,
                                       std::size_t last, const MotionNoise& noise);

/// Computes −2 ln of the likelihood of the innovations, but for the first two, which the unknown
/// start decides.
double InnovationMisfit(const PoseSeries& series, std::size_t first, std::size_t last,
                        const MotionNoise& noise);

}  // namespace stereomotion
