#include "motion/butterworth.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>

namespace stereomotion {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Transforms 1 / (s² + 2ζs + 1), s in units of the cut-off, bilinearly; `k` is the warped cut-off.
FilterSection SecondOrder(double k, double zeta) {
  const double scale = 1 / (1 + 2 * zeta * k + k * k);
  const double b0 = k * k * scale;
  return {b0, 2 * b0, b0, 2 * (k * k - 1) * scale, (1 - 2 * zeta * k + k * k) * scale};
}

/// Transforms 1 / (s + 1) likewise.
FilterSection FirstOrder(double k) {
  const double b0 = k / (1 + k);
  return {b0, b0, 0, (k - 1) / (k + 1), 0};
}

/// Finds the largest magnitude of a section's poles.
double LargestPole(const FilterSection& section) {
  const double discriminant = section.a1 * section.a1 / 4 - section.a2;
  if (discriminant < 0) return std::sqrt(section.a2);
  return std::abs(section.a1) / 2 + std::sqrt(discriminant);
}

/// Runs a signal through a section in place, from the steady state of its first sample.
template <class Signal>
void RunSection(const FilterSection& f, Signal&& signal) {
  // Transposed direct form II; at rest on x its state is this (gain 1 at frequency 0).
  double z2 = (f.b2 - f.a2) * signal[0];
  double z1 = (f.b1 - f.a1) * signal[0] + z2;
  for (Eigen::Index i = 0; i < signal.size(); ++i) {
    const double x = signal[i], y = f.b0 * x + z1;
    z1 = f.b1 * x - f.a1 * y + z2;
    z2 = f.b2 * x - f.a2 * y;
    signal[i] = y;
  }
}

}  // namespace

std::vector<FilterSection> DesignZeroPhaseButterworth(int order, double cutoff_hz, double rate_hz) {
  if (order < 2 || order % 2 != 0) {
    throw std::invalid_argument("Butterworth filter: the order of both passes must be even, ≥ 2");
  }
  // Of the rate: it comes from times that are rounded, to 1 µs at 1 kHz in the worst case.
  constexpr double kRounding = 1e-3;
  if (!(cutoff_hz > 0) || !(cutoff_hz < (1 - kRounding) * rate_hz / 2)) {
    throw std::invalid_argument(
        "Butterworth filter: the cut-off must lie between 0 and half the "
        "frame rate");
  }
  const int per_pass = order / 2;
  const double correction = std::pow(std::sqrt(2.0) - 1, 1.0 / (2 * per_pass));
  const double k = std::tan(kPi * cutoff_hz / rate_hz) / correction;
  std::vector<FilterSection> sections;
  if (per_pass % 2 == 1) sections.push_back(FirstOrder(k));
  for (int i = 1; i <= per_pass / 2; ++i) {
    sections.push_back(SecondOrder(k, std::sin(kPi * (2 * i - 1) / (2 * per_pass))));
  }
  return sections;
}

int ImpulseLength(const std::vector<FilterSection>& sections) {
  constexpr double kDead = 1e-8;
  constexpr int kLongest = 1 << 20;
  double pole = 0;
  for (const FilterSection& section : sections) pole = std::max(pole, LargestPole(section));
  if (pole <= kDead) return 2;
  const double length = std::ceil(std::log(kDead) / std::log(pole)) + 2;
  return static_cast<int>(std::min<double>(length, kLongest));
}

Eigen::VectorXd FilterForwardBackward(const std::vector<FilterSection>& sections,
                                      const Eigen::VectorXd& signal, int padding) {
  const Eigen::Index n = signal.size();
  assert(padding >= 0 && padding < n);
  Eigen::VectorXd padded(n + 2 * padding);
  padded.segment(padding, n) = signal;
  for (int i = 1; i <= padding; ++i) {
    padded[padding - i] = 2 * signal[0] - signal[i];
    padded[padding + n - 1 + i] = 2 * signal[n - 1] - signal[n - 1 - i];
  }
  for (const FilterSection& section : sections) RunSection(section, padded);
  for (const FilterSection& section : sections) RunSection(section, padded.reverse());
  return padded;
}

}  // namespace stereomotion
