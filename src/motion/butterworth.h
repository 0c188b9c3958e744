#pragma once

#include <Eigen/Core>
#include <vector>

namespace stereomotion {

/// Holds a section of second order, direct form: y = b0 x + b1 x₁ + b2 x₂ − a1 y₁ − a2 y₂. Its gain
/// at frequency 0 is 1. A section of first order has b2 = a2 = 0.
struct FilterSection {
  double b0 = 1, b1 = 0, b2 = 0, a1 = 0, a2 = 0;
};

/// Designs a Butterworth low pass for a signal that runs through it twice (forward and backward):
/// BOTH passes together have −3 dB at `cutoff_hz`. Each pass has half of `order` and a cut-off that
/// is higher by 1 / C, C = (2^(1/n) − 1)^(1/(2m)), n = 2 passes of order m (Winter 2009,
/// Biomechanics and Motor Control of Human Movement, sec. 3.4.4.2), on the prewarped axis of the
/// bilinear transform. Throws std::invalid_argument: order not even and positive, cut-off outside
/// (0, half the rate).
std::vector<FilterSection> DesignZeroPhaseButterworth(int order, double cutoff_hz, double rate_hz);

/// Counts the samples after which an impulse has died down to 1e-8 of its height.
int ImpulseLength(const std::vector<FilterSection>& sections);

/// Runs a signal forward and backward through all sections. `padding` samples are added to both
/// ends by point reflection (2 x₀ − x_k), and each pass starts in the steady state of its first
/// sample (Gustafsson 1996), as scipy.signal.sosfiltfilt does. The result keeps the padding.
/// `padding` must be less than the signal's length.
Eigen::VectorXd FilterForwardBackward(const std::vector<FilterSection>& sections,
                                      const Eigen::VectorXd& signal, int padding);

}  // namespace stereomotion
