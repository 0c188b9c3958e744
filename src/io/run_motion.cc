#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "line_plot.h"
#include "report_text.h"
#include "run_sections.h"

namespace stereomotion {
namespace {

constexpr double kDegreesPerRadian = 57.29577951308232;
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

void AddCenter(const SpinCenter& center, HtmlTable& table) {
  const std::string across = center.free_axis_in_body ? ", across the free axis" : "";
  table.AddRow({"spin centre in the body [mm]" + across,
                VectorText(center.in_body_mm, center.covariance_mm2)});
  if (center.free_axis_in_body) {
    table.AddRow({"free along, in the body", Direction(*center.free_axis_in_body)});
  }
  if (center.states.empty()) return;
  const CenterState& first = center.states.front();
  const bool rests = center.law == PathLaw::kFixed;
  table.AddRow({rests ? "… in the world [mm]" : "… in the world, first frame [mm]",
                VectorText(first.position_mm, first.covariance.topLeftCorner<3, 3>())});
  if (!rests) {
    table.AddRow({"its velocity, first frame [mm/s]",
                  VectorText(first.velocity_mm_s, first.covariance.block<3, 3>(3, 3))});
  }
  if (first.calibration_u_mm) {
    table.AddRow({"common to all frames (calibration, body) [mm]",
                  Digits(first.calibration_u_mm->maxCoeff(), 2)});
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
  if (motion.spin.center) AddCenter(*motion.spin.center, table);
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
    const BodyVelocity& at = motion.samples[i].velocity;
    const Eigen::Vector3d& value = row == 0 ? at.omega_rad_s : at.velocity_mm_s;
    const bool known = motion.samples[i].status != MotionStatus::kGap;
    plot.x.push_back(SecondsAfterFirst(motion.series, i));
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      PlotLine& line = plot.lines[static_cast<std::size_t>(axis)];
      line.values.push_back(known ? value[axis] : kNone);
      line.half_widths.push_back(known ? 2 * SigmaOf(at.covariance(row + axis, row + axis)) : 0);
    }
  }
  return DrawLinePlot(plot);
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
  for (const auto& warning : motion.warnings) text += "<p>" + EscapeHtml(warning) + "</p>\n";
  constexpr const char* kBand =
      ": <b class=\"x\">x</b>, <b class=\"y\">y</b>, <b class=\"z\">z</b> in the world. Band: ± 2 "
      "σ "
      "from image noise.";
  const char* of = motion.spin.center ? "Velocity of the spin centre"
                                      : "Velocity of the body's "
                                        "origin";
  return text + Outcome(motion) + Evidence(motion.spin) + "<div class=\"figures\">\n" +
         VelocityPlot(motion, 0, "Angular velocity", "ω [rad/s]",
                      std::string("Angular velocity") + kBand) +
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
