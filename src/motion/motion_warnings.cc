#include "motion_warnings.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "stereomotion/core/units.h"

namespace stereomotion {
namespace {

using Notes = std::vector<std::string>;

void NoteGaps(const PoseSeries& series, Notes& notes) {
  std::size_t lost = 0;
  double longest_s = 0;
  std::size_t last = series.size();
  for (std::size_t i = 0; i < series.size(); ++i) {
    lost += series[i].measured ? 0 : 1;
    if (!series[i].measured) continue;
    if (last < i && i - last > 1) {
      longest_s =
          std::max(longest_s, SecondsAfterFirst(series, i) - SecondsAfterFirst(series, last));
    }
    last = i;
  }
  if (lost == 0) return;
  notes.push_back(
      fmt::format("no pose in {} of {} frames (longest gap {:.3g} s): their rows are empty "
                  "or flagged as filled",
                  lost, series.size(), longest_s));
}

void NoteFreeRoll(const PoseSeries& series, Notes& notes) {
  const auto free = std::count_if(series.begin(), series.end(), [](const PoseSample& pose) {
    return pose.measured && pose.free_axis_in_world.has_value();
  });
  if (free == 0) return;
  notes.push_back(
      fmt::format("the body is a single rod: its roll is not seen in {} {}, and a turn "
                  "about the rod leaves no trace in this answer",
                  free, free == 1 ? "frame" : "frames"));
}

bool IsOneRod(const PoseSeries& series) {
  return std::all_of(series.begin(), series.end(), [](const PoseSample& pose) {
    return !pose.measured || pose.free_axis_in_world.has_value();
  });
}

const LawFit* FitOf(const SpinCenterResult& spin, PathLaw law) {
  for (const LawFit& fit : spin.laws) {
    if (fit.law == law) return &fit;
  }
  return nullptr;
}

void NoteLaw(const SpinCenterResult& spin, Notes& notes) {
  const std::string_view word = LawWord(spin.law);
  const LawFit* fit = FitOf(spin, spin.law);
  if (spin.law_given && fit != nullptr && !fit->adequate && spin.law != PathLaw::kFree) {
    notes.push_back(
        fmt::format("the law '{}' was asked for, but the data contradicts it (χ² {:.4g} for {} "
                    "degrees of freedom): its uncertainties do not hold",
                    word, fit->chi2, fit->dof));
  }
  if (spin.evidence_open && spin.law == PathLaw::kFree) {
    notes.push_back(
        "too few frames to tell the law of the spin centre's path; name it (--law) if you know "
        "it");
  } else if (spin.evidence_open) {
    notes.push_back(
        fmt::format("a narrower law explains the data about as well as '{}': the wider one's "
                    "uncertainty is given; name the law (--law) if you know it",
                    word));
  }
  if (!spin.law_given && spin.law == PathLaw::kAccelerated) {
    notes.push_back(
        "the spin centre hangs on the law 'accelerated', the widest there is: no wider one can "
        "contradict it, and on a path that only looks like it the centre is elsewhere");
  }
  if (!spin.law_given && spin.law == PathLaw::kFree && !spin.evidence_open) {
    notes.push_back(
        "no point of the body rests, or moves uniformly or with constant acceleration: "
        "there is no spin centre; axes.csv has the screw axis of each interval");
  }
  if (!spin.left_out.empty()) {
    notes.push_back(
        fmt::format("left out of the spin centre, for they contradict the law of the others: {} {}",
                    spin.left_out.size(), spin.left_out.size() == 1 ? "frame" : "frames"));
  }
}

// The usual model error: vibration, a body that bends, a lens that the rig does not describe.
void NoteNoise(const SpinCenterResult& spin, Notes& notes) {
  const LawFit* free = FitOf(spin, PathLaw::kFree);
  if (free == nullptr || free->dof < 1) return;
  const double ratio = free->chi2 / free->dof;
  constexpr double kDoubtful = 2;  // as in the verdict of report.html
  if (ratio < kDoubtful) return;
  notes.push_back(
      fmt::format("the residuals are {:.2g} times as large as their uncertainties say "
                  "(χ²/dof {:.3g}): the given uncertainties are too small by about that",
                  std::sqrt(ratio), ratio));
}

void NoteAxis(const MotionAnalysis& analysis, Notes& notes) {
  if (!analysis.axis && IsOneRod(analysis.series)) {
    notes.push_back("what is seen of a single rod's rotation tells no axis");
    return;
  }
  if (!analysis.axis) {
    notes.push_back("the rotation does not rise above its noise: there is no axis");
    return;
  }
  const OneAxis& axis = analysis.axis->axis;
  if (axis.accepted) return;
  notes.push_back(
      fmt::format("the body turned about more than one axis: the mean axis is only their "
                  "summary (RMS deviation {:.3g}°)",
                  kDegreesPerRadian * axis.dispersion_rad));
}

double BodyRadius_mm(const std::vector<Eigen::Vector3d>& balls_mm) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& ball : balls_mm) mean += ball / static_cast<double>(balls_mm.size());
  double square = 0;
  for (const auto& ball : balls_mm) square += (ball - mean).squaredNorm();
  return balls_mm.empty() ? 0 : std::sqrt(square / static_cast<double>(balls_mm.size()));
}

void NoteWideCenter(const MotionData& data, const SpinCenterResult& spin, Notes& notes) {
  const double radius_mm = BodyRadius_mm(data.balls_in_body_mm);
  if (!spin.center || radius_mm <= 0) return;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spin.center->covariance_mm2,
                                                              Eigen::EigenvaluesOnly);
  const double u_mm = std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff()));
  if (u_mm < radius_mm) return;
  notes.push_back(
      fmt::format("range of rotation {:.3g}°: the spin centre is known only to ± {:.2g} mm "
                  "(one sigma), worse than the body is large; turn it farther",
                  kDegreesPerRadian * spin.range_of_rotation_rad, u_mm));
}

// Two significant digits of the uncertainty, as in the summary on the terminal.
int DecimalsFor(double u) {
  constexpr int kMost = 9;
  if (!(u > 0) || !std::isfinite(u)) return 3;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(u))), 0, kMost);
}

void NoteOffset(const MotionAnalysis& analysis, Notes& notes) {
  if (!analysis.time_offset) return;
  const TimeOffset& offset = *analysis.time_offset;
  constexpr double kMsPerS = 1000;
  if (offset.significant) {
    notes.push_back(fmt::format(
        "the right camera's images are {0:.{2}f} ± {1:.{2}f} ms later than their time says; "
        "{3}",
        kMsPerS * offset.offset_s, kMsPerS * offset.u_s, DecimalsFor(kMsPerS * offset.u_s),
        analysis.time_offset_applied
            ? "the motion is given for the left camera's time"
            : "so long a recording is not corrected for it: track it in parts (--start, --count)"));
  }
  if (!offset.warning.empty()) notes.push_back(offset.warning);
}

}  // namespace

std::vector<std::string> MotionWarnings(const MotionData& data, const MotionAnalysis& analysis,
                                        std::size_t stride) {
  Notes notes;
  if (stride > 1) {
    notes.push_back(
        fmt::format("the recording is long: the spin centre comes from every {}th pose, "
                    "velocities and axes from all",
                    stride));
  }
  NoteGaps(analysis.series, notes);
  NoteFreeRoll(analysis.series, notes);
  NoteOffset(analysis, notes);
  NoteNoise(analysis.spin, notes);
  NoteLaw(analysis.spin, notes);
  NoteAxis(analysis, notes);
  NoteWideCenter(data, analysis.spin, notes);
  return notes;
}

}  // namespace stereomotion
