#include "plan_intrinsics.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>

namespace stereomotion {
namespace {

using Mask = std::array<bool, CameraModel::kNumParameters>;

// How a single frame's points are spent. Each camera's pose takes six of 2 n observations. With 6
// and 7 points the rest goes to what a DLT estimates but for the skew; from 8 on square pixels,
// radial and tangential distortion of the lowest order say more (measured on the frame of
// control_frame_myptv: held-out error against the predicted one, docs/calibration.md); from 24 on
// everything.
constexpr int kDistortion = 8;
constexpr int kAll = 24;

constexpr Mask kUsual = {true, true, true, true, true, true, true, true, false};

struct Limited {
  Mask mask;
  bool one_focal_length;  // fx = fy
};

Limited Limit(const Mask& asked, int points) {
  Limited limited{asked, false};
  if (points >= kAll) return limited;
  limited.mask[5] = limited.mask[8] = false;
  if (points < kDistortion) limited.mask[4] = limited.mask[6] = limited.mask[7] = false;
  limited.one_focal_length = points >= kDistortion && asked[0] && asked[1];
  return limited;
}

int CountPoints(const std::vector<TargetObservation>& observations, int camera) {
  std::set<int> points;
  for (const auto& o : observations) {
    if (o.camera == camera) points.insert(o.point);
  }
  return static_cast<int>(points.size());
}

std::string NameMask(const Mask& mask, bool tied) {
  const char* const names[] = {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"};
  std::vector<std::string> list;
  for (int i = 0; i < CameraModel::kNumParameters; ++i) {
    if (!mask[i] || (tied && i == 1)) continue;
    list.emplace_back(tied && i == 0 ? "one focal length" : names[i]);
  }
  return list.empty() ? "nothing" : fmt::format("{}", fmt::join(list, ", "));
}

}  // namespace

IntrinsicsPlan PlanIntrinsics(const CalibrationSetup& setup,
                              const std::vector<TargetObservation>& observations) {
  IntrinsicsPlan plan;
  int next = 0;
  for (std::size_t c = 0; c < setup.cameras.size(); ++c) {
    const CalibrationCamera& camera = setup.cameras[c];
    const Mask asked = camera.free.value_or(kUsual);
    Limited limited{asked, false};
    if (setup.target.type == TargetType::kControlPoints) {
      const int points = CountPoints(observations, static_cast<int>(c));
      limited = Limit(asked, points);
      if (points < kDistortion) {
        plan.notes.push_back(
            {"few_points",
             fmt::format("camera {}: {} points leave almost nothing over: a wrong one cannot be "
                         "told, and about one such rig in ten errs several times more than it "
                         "states; take {} points or more, better {}",
                         camera.name, points, kDistortion, kAll)});
      }
      if (limited.mask != asked || limited.one_focal_length) {
        plan.notes.push_back(
            {"intrinsics_reduced",
             fmt::format("camera {}: {} points cannot carry all of {}; estimated: {}. More points "
                         "({} and more) determine the lens",
                         camera.name, points, NameMask(asked, false),
                         NameMask(limited.mask, limited.one_focal_length), kAll)});
      }
    }
    auto& unknown = plan.unknown.emplace_back();
    for (int i = 0; i < CameraModel::kNumParameters; ++i) {
      unknown[i] = limited.mask[i] && !(limited.one_focal_length && i == 1) ? next++ : -1;
    }
    if (limited.one_focal_length) unknown[1] = unknown[0];
  }
  return plan;
}

}  // namespace stereomotion
