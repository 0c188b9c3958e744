#include "fit_recording.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "thin_recording.h"

namespace stereomotion {
namespace {

bool Applies(const std::optional<TimeOffset>& offset, const MotionData& data) {
  return offset && offset->significant && HasAllPoints(data);
}

// `kept`: the frames of a thinned recording; empty: all, gaps included.
SpinCenterResult FindAt(const MotionData& data, const std::vector<std::size_t>& kept,
                        const SpinCenterOptions& options) {
  if (kept.empty()) return FindSpinCenter(data, options);
  return FindSpinCenter(FramesAt(data, kept), options);
}

// What may still be wrong with the times: of an offset that is applied its σ; of one that is left
// out also what it was estimated at, up to where it would have counted (4 σ).
double RemainingOffset_s(const TimeOffset& offset, bool applied) {
  constexpr double kSignificant = 4;
  const double u_s = std::hypot(offset.u_s, offset.calibration_u_s);
  const double left_out_s = applied ? 0 : std::min(std::abs(offset.offset_s), kSignificant * u_s);
  return std::hypot(u_s, left_out_s);
}

// What the offset's uncertainty does to the centre, to first order: `moved` is the fit of data that
// is later by one standard uncertainty. A common part.
void AddOffsetPart(const SpinCenter& moved, SpinCenter& center) {
  const Eigen::Vector3d shift_mm = moved.in_body_mm - center.in_body_mm;
  center.calibration_covariance_mm2 =
      center.calibration_covariance_mm2.value_or(Eigen::Matrix3d::Zero()) +
      shift_mm * shift_mm.transpose();
  for (std::size_t i = 0; i < center.states.size(); ++i) {
    CenterState& state = center.states[i];
    const Eigen::Vector3d way_mm = moved.states[i].position_mm - state.position_mm;
    const Eigen::Vector3d u_mm = state.calibration_u_mm.value_or(Eigen::Vector3d::Zero());
    state.calibration_u_mm = (u_mm.array().square() + way_mm.array().square()).sqrt().matrix();
  }
}

// `data` as recorded: moving it twice would interpolate twice.
void AddOffsetUncertainty(const MotionData& data, const TimeOffset& offset, bool applied,
                          const std::vector<std::size_t>& kept, const SpinCenterOptions& options,
                          SpinCenterResult& spin) {
  if (!spin.center || !options.with_calibration || !HasAllPoints(data)) return;
  // Without any other common part stated, this one alone would pass for the whole.
  if (!spin.center->calibration_covariance_mm2) return;
  SpinCenterOptions same = options;
  same.law = spin.law;
  same.only_given_law = true;
  same.with_calibration = false;
  const double later_s = (applied ? offset.offset_s : 0) + RemainingOffset_s(offset, applied);
  const SpinCenterResult moved = FindAt(WithTimeOffset(data, later_s), kept, same);
  if (!moved.center || moved.center->states.size() != spin.center->states.size()) return;
  AddOffsetPart(*moved.center, *spin.center);
}

}  // namespace

bool HasAllPoints(const MotionData& data) {
  bool some = false, all = true;
  for (const MotionFrame& frame : data.frames) {
    if (!frame.pose.measured) continue;
    const bool has = !frame.image_points.empty();
    some = some || has;
    all = all && has;
  }
  return all || !some;
}

std::vector<bool> FitRecording(const MotionData& data, const AnalyseOptions& options,
                               std::size_t stride, MotionAnalysis& analysis) {
  std::optional<TimeOffset>& offset = analysis.time_offset;
  if (options.estimate_time_offset) {
    offset = EstimateTimeOffset(stride > 1 ? FirstPart(data, kOffsetFrames) : data);
  }
  analysis.time_offset_applied = Applies(offset, data);
  MotionData moved;
  if (analysis.time_offset_applied) {
    moved =
        WithTimeOffset(data, offset->offset_s, std::hypot(offset->u_s, offset->calibration_u_s));
  }
  const MotionData& source = analysis.time_offset_applied ? moved : data;
  analysis.series = PosesOf(source);

  const std::vector<std::size_t> kept =
      stride > 1 ? EveryNthPose(source, stride) : std::vector<std::size_t>();
  analysis.spin = FindAt(source, kept, options.center);
  if (offset) {
    AddOffsetUncertainty(data, *offset, analysis.time_offset_applied, kept, options.center,
                         analysis.spin);
  }
  if (!kept.empty()) return SpreadOverSeries(analysis.series, kept, analysis.spin);
  return std::vector<bool>(analysis.series.size(), true);
}

}  // namespace stereomotion
