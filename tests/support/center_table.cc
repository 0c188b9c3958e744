#include "tests/support/center_table.h"

#include <fmt/format.h>

#include <string>

#include "tests/support/motion_bound.h"
#include "tests/support/motion_cases.h"

namespace stereomotion::testing {
namespace {

void BoundAcross(const std::string& quantity, const std::optional<Eigen::Vector3d>& axis,
                 const Eigen::Matrix3d& covariance, CoverageTable& table) {
  if (!axis) return table.SetBound(quantity, covariance);
  const auto ways = Across(*axis);
  table.SetBound(quantity, ways.transpose() * covariance * ways);
}

struct Watched {
  std::size_t frame;
  std::string name;
};

std::vector<Watched> WatchedFrames(const MotionScene& scene) {
  const std::size_t n = scene.truth.size();
  return {{0, "first"}, {n / 2, "middle"}, {n - 1, "last"}};
}

constexpr const char* kStateNames[] = {"position", "velocity", "acceleration"};

int OrderOf(PathLaw law) { return static_cast<int>(law); }

}  // namespace

void AddCenter(const MotionScene& scene, const SpinCenter& center, CoverageTable& table) {
  const Eigen::Vector3d truth_mm = IdentifiableCenter(scene);
  AddAcross("centre in body", TrueAxisInBody(scene.plan), center.in_body_mm - truth_mm,
            center.covariance_mm2, table);
  const auto axis = TrueAxisInWorld(scene.plan);
  for (const auto& [frame, name] : WatchedFrames(scene)) {
    const CenterState& state = center.states.at(frame);
    Eigen::Matrix<double, 9, 1> error;
    error << state.position_mm, state.velocity_mm_s, state.acceleration_mm_s2;
    error -= TrueStateOf(scene.truth[frame], truth_mm);
    for (int d = 0; d <= OrderOf(center.law); ++d) {
      AddAcross(fmt::format("{}, {}", kStateNames[d], name), d == 0 ? axis : std::nullopt,
                error.segment<3>(3 * d), state.covariance.block<3, 3>(3 * d, 3 * d), table);
    }
  }
}

void StateBounds(const MotionScene& scene, PathLaw law, CoverageTable& table) {
  const MotionBound bound = BoundOf(scene, law);
  BoundAcross("centre in body", TrueAxisInBody(scene.plan), bound.center_mm2, table);
  const auto axis = TrueAxisInWorld(scene.plan);
  for (const auto& [frame, name] : WatchedFrames(scene)) {
    for (int d = 0; d <= OrderOf(law); ++d) {
      BoundAcross(fmt::format("{}, {}", kStateNames[d], name), d == 0 ? axis : std::nullopt,
                  bound.states[frame].block<3, 3>(3 * d, 3 * d), table);
    }
  }
}

}  // namespace stereomotion::testing
