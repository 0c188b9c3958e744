#include "pose/verify_pose.h"

#include <algorithm>
#include <cmath>

#include "pose/body_geometry.h"
#include "stereomotion/camera/sphere_projection.h"

namespace stereomotion {
namespace {

bool SameAssignments(const std::vector<BallAssignment>& a, const std::vector<BallAssignment>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const BallAssignment& x, const BallAssignment& y) {
                      return x.id == y.id && x.camera == y.camera && x.detection == y.detection;
                    });
}

}  // namespace

Expected<PoseFix, PoseStatus> VerifyPose(const PoseView& view, const Rigid3& world_from_body,
                                         double gate_px, const PoseOptions& options) {
  Rigid3 placement = world_from_body;
  std::vector<BallAssignment> last;
  constexpr int kRounds = 4;
  for (int round = 0;; ++round) {
    const auto assignments =
        AssignDetections(view.left, view.right, view.body, view.left_balls, view.right_balls,
                         placement, round == 0 ? gate_px : std::min(gate_px, kEstimateGatePx));
    PoseFix fix;
    const auto pose = EstimatePose(view.left, view.right, view.body, view.left_balls,
                                   view.right_balls, assignments, placement, options, &fix.used);
    if (!pose) return Unexpected{pose.error()};
    fix.pose = *pose;
    if (SameAssignments(assignments, last)) return fix;
    // An assignment that never settles is no arrangement of balls.
    if (round == kRounds) return Unexpected{PoseStatus::kLost};
    last = assignments;
    placement = BodyPlacement(view.body, *pose);
  }
}

int CountExpected(const PoseView& view, const Rigid3& world_from_body) {
  int expected = 0;
  for (const BallId& id : AllBalls(view.body)) {
    for (const RigCamera* camera : {&view.left, &view.right}) {
      const auto sphere = ProjectSphere(
          camera->model, camera->cam_from_world * (world_from_body * BallInBody(view.body, id)),
          BallRadius(view.body, id));
      if (!sphere) continue;
      const double margin_px = sphere->outline.semi_major_px;
      const Eigen::Vector2d& center_px = sphere->outline.center_px;
      const bool inside = (center_px.array() > margin_px).all() &&
                          center_px.x() < camera->width_px - 1 - margin_px &&
                          center_px.y() < camera->height_px - 1 - margin_px;
      if (inside) ++expected;
    }
  }
  return expected;
}

bool AreDifferent(const Body& body, const PoseEstimate& a, const PoseEstimate& b) {
  const Rigid3 at_a = BodyPlacement(body, a);
  const Rigid3 at_b = BodyPlacement(body, b);
  for (const BallId& id : AllBalls(body)) {
    const double shift_mm = (at_a * BallInBody(body, id) - at_b * BallInBody(body, id)).norm();
    const double sigma_mm = std::hypot(BallSigmaMm(body, a, id), BallSigmaMm(body, b, id));
    if (shift_mm > std::max(1.0, 10 * sigma_mm)) return true;
  }
  return false;
}

double ChiSquareLevel(const PoseEstimate& pose) {
  return std::max(1.0, pose.chi2 / std::max(1, pose.dof));
}

bool ExplainsMore(const PoseFix& a, const PoseFix& b) {
  if (a.used.size() != b.used.size()) return a.used.size() > b.used.size();
  return a.pose.chi2 < b.pose.chi2;
}

bool AreRivals(const PoseFix& best, const PoseFix& other) {
  constexpr double kComparable =
      10;  // of χ² per degree of freedom: false arrangements are off by 10⁴
  return other.used.size() + 1 >= best.used.size() &&
         ChiSquareLevel(other.pose) <= kComparable * ChiSquareLevel(best.pose);
}

}  // namespace stereomotion
