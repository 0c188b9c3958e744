#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "line_plot.h"
#include "open_turn.h"
#include "report_text.h"
#include "run_sections.h"
#include "stereomotion/core/units.h"
#include "stereomotion/io/motion_writer.h"

namespace stereomotion {
namespace {

constexpr double kMsPerS = 1000;
constexpr std::size_t kMostPoints = 2000;  // more than a screen has pixels across
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<const char*, 3> kStyles = {"x", "y", "z"};

double SigmaOf(double variance) { return std::sqrt(std::max(0.0, variance)); }

std::string WithSigma(double value, double sigma) {
  return ValueText(value, sigma) + " ± " + Digits(sigma, 2);
}

std::string VectorText(const Eigen::Vector3d& value, const Eigen::Matrix3d& covariance) {
  std::string text;
  for (Eigen::Index i = 0; i < 3; ++i) {
    text += (i > 0 ? ", " : "") + WithSigma(value[i], SigmaOf(covariance(i, i)));
  }
  return "(" + text + ")";
}

std::string Direction(const Eigen::Vector3d& axis) {
  return fmt::format("({:.4f}, {:.4f}, {:.4f})", axis.x(), axis.y(), axis.z());
}

void AddCenter(const SpinCenter& center, const PoseSeries& series, HtmlTable& table) {
  const std::string across = center.free_axis_in_body ? ", across the free axis" : "";
  table.AddRow({"spin centre in the body [mm]" + across,
                VectorText(center.in_body_mm, center.covariance_mm2)});
  if (center.free_axis_in_body) {
    table.AddRow({"free along, in the body", Direction(*center.free_axis_in_body)});
  }
  if (series.empty() || center.states.size() != series.size()) return;
  const CenterState& state = center.states[MiddleFrame(series)];
  const bool rests = center.law == PathLaw::kFixed;
  table.AddRow({rests ? "… in the world [mm]" : "… in the world, mid-run [mm]",
                VectorText(state.position_mm, state.covariance.topLeftCorner<3, 3>())});
  if (!rests) {
    table.AddRow({"its velocity, mid-run [mm/s]",
                  VectorText(state.velocity_mm_s, state.covariance.block<3, 3>(3, 3))});
  }
  if (state.calibration_u_mm) {
    table.AddRow({"common to all frames (calibration, body) [mm]",
                  Digits(state.calibration_u_mm->maxCoeff(), 2)});
  }
}

void AddAxis(const MeanAxis& mean, HtmlTable& table) {
  table.AddRow({"mean axis in the world", Direction(mean.axis.in_world) + " ± " +
                                              Digits(kDegreesPerRadian * mean.u_direction_rad, 2) +
                                              "°"});
  table.AddRow({"… through [mm]",
                VectorText(mean.point_in_world_mm,
                           mean.u_point_mm * mean.u_point_mm * Eigen::Matrix3d::Identity())});
  table.AddRow({"pitch [mm/rad]", WithSigma(mean.pitch_mm_per_rad, mean.u_pitch)});
  table.AddRow(
      {"axis wanders by (RMS)", Digits(kDegreesPerRadian * mean.axis.dispersion_rad, 2) + "°"});
}

std::string Outcome(const MotionAnalysis& motion) {
  HtmlTable table("ll", {"", ""});
  table.AddRow(
      {"rotation, back and forth added up", Digits(kDegreesPerRadian * motion.total_rad, 4) + "°"});
  table.AddRow({"mean rate", Digits(kDegreesPerRadian * motion.mean_rate_rad_s, 4) + " °/s"});
  table.AddRow({"law of the centre's path",
                std::string(LawWord(motion.spin.law)) + (motion.spin.law_given ? " (given)" : "")});
  if (motion.spin.center) AddCenter(*motion.spin.center, motion.series, table);
  if (motion.axis) AddAxis(*motion.axis, table);
  if (motion.time_offset) {
    table.AddRow(
        {"right camera late by [ms]",
         WithSigma(kMsPerS * motion.time_offset->offset_s, kMsPerS * motion.time_offset->u_s) +
             (motion.time_offset->significant ? ", corrected" : ", not significant")});
  }
  return table.Text();
}

std::string Evidence(const SpinCenterResult& spin) {
  HtmlTable table("lrrrl", {"law", "χ²", "degrees of freedom", "BIC", "explains the data"});
  for (const LawFit& fit : spin.laws) {
    table.AddRow({std::string(LawWord(fit.law)), Digits(fit.chi2, 6), std::to_string(fit.dof),
                  Digits(fit.bic, 6), fit.adequate ? "yes" : "no"});
  }
  return spin.laws.empty() ? "" : "<h3>Evidence for the law</h3>\n" + table.Text();
}

/// Components of ω (row 0) or v (row 3) with their standard uncertainties; NaN: not determined.
struct Components {
  Eigen::Array3d values, sigmas;
};

Components ComponentsOf(const MotionSample& sample, Eigen::Index row) {
  const BodyVelocity& at = sample.velocity;
  Components known{row == 0 ? at.omega_rad_s : at.velocity_mm_s,
                   at.covariance.diagonal().segment<3>(row).cwiseMax(0).cwiseSqrt()};
  for (Eigen::Index k = 0; k < 3; ++k) {
    const bool is_open = row == 0 && IsTurnOpen(at, k);
    if (sample.status != MotionStatus::kGap && !is_open && std::isfinite(known.sigmas[k])) continue;
    known.values[k] = kNone;
    known.sigmas[k] = 0;
  }
  return known;
}

/// Draws three components of the velocities with their bands, from `row` of the covariance on.
std::string VelocityPlot(const MotionAnalysis& motion, Eigen::Index row, const char* title,
                         const char* y_name, const std::string& caption) {
  LinePlot plot;
  plot.title = title;
  plot.x_name = "time from the first pair [s]";
  plot.y_name = y_name;
  plot.caption = caption;
  for (const char* style : kStyles) plot.lines.push_back({style, {}, {}});
  const std::size_t count = std::min(motion.samples.size(), motion.series.size());
  const std::size_t step = 1 + count / kMostPoints;
  for (std::size_t i = 0; i < count; i += step) {
    const Components known = ComponentsOf(motion.samples[i], row);
    plot.x.push_back(SecondsAfterFirst(motion.series, i));
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      PlotLine& line = plot.lines[static_cast<std::size_t>(axis)];
      line.values.push_back(known.values[axis]);
      line.half_widths.push_back(2 * known.sigmas[axis]);
    }
  }
  return DrawLinePlot(plot);
}

/// Tells whether no component of the angular velocity is determined in any frame.
bool TurnIsOpen(const MotionAnalysis& motion) {
  return !motion.samples.empty() &&
         std::all_of(motion.samples.begin(), motion.samples.end(), [](const MotionSample& sample) {
           return ComponentsOf(sample, 0).values.isNaN().all();
         });
}

bool RestsByLaw(const MotionAnalysis& motion) {
  return motion.spin.center && motion.spin.law == PathLaw::kFixed;
}

std::string Capitalized(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] += 'A' - 'a';
  return text;
}

}  // namespace

std::string RunMotionSection(const RunReport& report, std::size_t body) {
  if (report.bodies[body].motion == nullptr) return "";
  const MotionAnalysis& motion = *report.bodies[body].motion;
  std::string text = "<section>" + BodyHeading(report, body, "Motion");
  if (!motion.spin.verdict.empty()) {
    text += "<p><b>" + EscapeHtml(Capitalized(motion.spin.verdict)) + "</b></p>\n";
  }
  constexpr const char* kBand =
      ": <b class=\"x\">x</b>, <b class=\"y\">y</b>, <b class=\"z\">z</b> in the world. Band: ± 2 "
      "σ "
      "from image noise.";
  const char* of = motion.spin.center ? "Velocity of the spin centre"
                                      : "Velocity of the body's "
                                        "origin";
  return text + Outcome(motion) + Evidence(motion.spin) + "<div class=\"figures\">\n" +
         (TurnIsOpen(motion) ? "<p>No component of the angular velocity is determined.</p>\n"
                             : VelocityPlot(motion, 0, "Angular velocity", "ω [rad/s]",
                                            std::string("Angular velocity") + kBand)) +
         (RestsByLaw(motion)
              ? "<p>The spin centre rests: its velocity is zero by its law.</p>\n"
              : VelocityPlot(motion, 3, "Velocity", "v [mm/s]", std::string(of) + kBand)) +
         "</div></section>\n";
}

std::string RunJointsSection(const RunReport& report) {
  if (report.joints.empty()) return "";
  std::string text = "<section><h2>Joints</h2>\n";
  for (const std::string& joint : report.joints) text += "<p>" + EscapeHtml(joint) + "</p>\n";
  return text + "</section>\n";
}

}  // namespace stereomotion
