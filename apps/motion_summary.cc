#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "motion_run.h"
#include "stereomotion/core/units.h"
#include "stereomotion/io/motion_writer.h"

namespace stereomotion::app {
namespace {

std::string Line(const std::string& label, const std::string& value) {
  return fmt::format("  {:<26}{}\n", label, value);
}

// As many decimals as give the uncertainty two digits.
int Decimals(double u) {
  constexpr int kMost = 9;
  if (!(u > 0) || !std::isfinite(u)) return 3;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(u))), 0, kMost);
}

std::string WithSigma(double value, double u) {
  return fmt::format("{0:.{2}f} ± {1:.{2}f}", value, u, Decimals(u));
}

std::string Vector(const Eigen::Vector3d& vector, double u) {
  const int decimals = Decimals(u);
  return fmt::format("({0:.{3}f}, {1:.{3}f}, {2:.{3}f})", vector.x(), vector.y(), vector.z(),
                     decimals);
}

std::string VectorWithSigma(const Eigen::Vector3d& vector, const Eigen::Matrix3d& covariance) {
  const Eigen::Vector3d u = covariance.diagonal().cwiseMax(0).cwiseSqrt();
  // The second largest: along a free axis the smallest is none.
  const double typical = u.sum() - u.minCoeff() - u.maxCoeff();
  return Vector(vector, typical) + " ± " + Vector(u, typical);
}

// Bits of evidence for a person: by how much each other law's BIC is worse than the chosen one's.
std::string Evidence(const SpinCenterResult& spin) {
  double chosen = 0;
  for (const LawFit& fit : spin.laws) {
    if (fit.law == spin.law) chosen = fit.bic;
  }
  std::string text;
  for (const LawFit& fit : spin.laws) {
    if (fit.law == spin.law) continue;
    const double worse = fit.bic - chosen;
    const char* refuted = worse < 0 ? " (refuted by chi2)" : " (refuted)";
    text += fmt::format("{}{} {:+.1f}{}", text.empty() ? "" : ", ", LawWord(fit.law), worse,
                        fit.adequate ? "" : refuted);
  }
  return text.empty() ? "" : "BIC against it: " + text;
}

std::string Law(const SpinCenterResult& spin) {
  constexpr std::array<std::string_view, 4> kMeaning = {
      "it rests", "it moves at constant velocity", "it moves with constant acceleration",
      "no point of the body is told from the others"};
  std::string text =
      fmt::format("{}: {}", LawWord(spin.law), kMeaning[static_cast<std::size_t>(spin.law)]);
  if (spin.law_given) return text + " (as asked for)";
  return text + (spin.evidence_open ? " (evidence open)" : " (by evidence)");
}

// A verdict, a line a statement: it breaks at semicolons outside brackets, and before a bracket
// that holds a list.
std::string VerdictLines(const std::string& verdict) {
  std::string text, line;
  int depth = 0;
  for (const char c : verdict) {
    const bool list = c == '(' && verdict.find("(by law:") != std::string::npos;
    if (depth == 0 && (c == ';' || list)) {
      while (!line.empty() && line.back() == ' ') line.pop_back();
      text += Line(text.empty() ? "verdict" : "", line);
      line.clear();
    }
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    const bool separator = depth == 0 && (c == ';' || (c == ' ' && line.empty()));
    if (!separator) line += c;
  }
  return text + Line(text.empty() ? "verdict" : "", line);
}

std::string CenterLines(const MotionAnalysis& analysis) {
  const SpinCenterResult& spin = analysis.spin;
  std::string text = Line("law of the spin centre", Law(spin));
  if (const std::string evidence = Evidence(spin); !evidence.empty()) text += Line("", evidence);
  if (!spin.center) return text + Line("spin centre", spin.verdict);
  const SpinCenter& center = *spin.center;
  const CenterState& state = center.states[MiddleFrame(analysis.series)];
  text +=
      Line("spin centre in body, mm", VectorWithSigma(center.in_body_mm, center.covariance_mm2));
  text += Line("  in world, mid-run, mm",
               VectorWithSigma(state.position_mm, state.covariance.topLeftCorner<3, 3>()));
  if (state.calibration_u_mm) {
    text += Line(
        "  common part, mm",
        fmt::format("± {}", Vector(*state.calibration_u_mm, state.calibration_u_mm->minCoeff())));
  }
  if (center.law != PathLaw::kFixed) {
    text += Line("  its velocity, mm/s",
                 VectorWithSigma(state.velocity_mm_s, state.covariance.block<3, 3>(3, 3)));
  }
  return text + VerdictLines(spin.verdict);
}

std::string AxisLines(const MeanAxis& axis) {
  std::string text = Line(
      "mean axis in world",
      fmt::format("{} ± {:.2g}°{}", Vector(axis.axis.in_world, axis.u_direction_rad),
                  kDegreesPerRadian * axis.u_direction_rad,
                  axis.axis.accepted ? ""
                                     : fmt::format(" (of several: deviation {:.3g}°)",
                                                   kDegreesPerRadian * axis.axis.dispersion_rad)));
  text += Line(
      "  through, mm",
      fmt::format("{} ± {:.2g}", Vector(axis.point_in_world_mm, axis.u_point_mm), axis.u_point_mm));
  text += Line("  pitch, mm/rad", WithSigma(axis.pitch_mm_per_rad, axis.u_pitch));
  if (!axis.common) return text;
  std::string common =
      fmt::format("± {:.2g}°", kDegreesPerRadian * axis.common->ucal_direction_rad);
  if (axis.common->ucal_point_mm) common += fmt::format(", {:.2g} mm", *axis.common->ucal_point_mm);
  if (axis.common->ucal_pitch) common += fmt::format(", {:.2g} mm/rad", *axis.common->ucal_pitch);
  return text + Line("  common part", common);
}

// Smallest and largest speed of the centre or the origin, with the typical uncertainty.
std::string SpeedLine(const MotionAnalysis& analysis) {
  double lowest = INFINITY, highest = 0;
  for (const MotionSample& sample : analysis.samples) {
    if (sample.status == MotionStatus::kGap) continue;
    lowest = std::min(lowest, sample.velocity.velocity_mm_s.norm());
    highest = std::max(highest, sample.velocity.velocity_mm_s.norm());
  }
  if (lowest > highest) return "";
  return Line(analysis.spin.center ? "speed of the centre, mm/s" : "speed of the origin, mm/s",
              fmt::format("{:.4g} to {:.4g}", lowest, highest));
}

std::string RotationLines(const MotionAnalysis& analysis) {
  std::string text =
      Line("rotation", fmt::format("{:.4g}° in all, range {:.4g}°, mean rate {:.4g}°/s",
                                   kDegreesPerRadian * analysis.total_rad,
                                   kDegreesPerRadian * analysis.spin.range_of_rotation_rad,
                                   kDegreesPerRadian * analysis.mean_rate_rad_s));
  return text + SpeedLine(analysis);
}

}  // namespace

std::string MotionSummary(const MotionAnalysis& analysis) {
  const PoseSeries& series = analysis.series;
  const auto measured = std::count_if(series.begin(), series.end(),
                                      [](const PoseSample& pose) { return pose.measured; });
  const double span_s = series.empty() ? 0 : SecondsAfterFirst(series, series.size() - 1);
  std::string text = Line("motion", fmt::format("{} of {} frames have a pose, {:.3f} s", measured,
                                                series.size(), span_s));
  if (analysis.spin.laws.empty()) return text + Line("", analysis.spin.verdict);
  text += RotationLines(analysis);
  text += CenterLines(analysis);
  if (analysis.axis) text += AxisLines(*analysis.axis);
  if (analysis.time_offset) {
    constexpr double kMsPerS = 1000;
    text += Line(
        "right camera late by, ms",
        WithSigma(kMsPerS * analysis.time_offset->offset_s, kMsPerS * analysis.time_offset->u_s) +
            (analysis.time_offset_applied ? " (corrected)" : " (not corrected)"));
  }
  return text;
}

}  // namespace stereomotion::app
