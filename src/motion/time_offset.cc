#include "stereomotion/motion/time_offset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "motion/offset_problem.h"

namespace stereomotion {
namespace {

bool SeenByBoth(const MotionData& data) {
  bool seen[2] = {false, false};
  for (const MotionFrame& frame : data.frames) {
    for (const ImagePoint& point : frame.image_points) seen[point.camera == 1 ? 1 : 0] = true;
  }
  return seen[0] && seen[1] && !data.rig.cameras.empty();
}

/// Says what keeps the offset from being known well; empty where nothing does.
std::string Warning(double u_s, double period_s, double share) {
  // Share of the right camera's information that the poses leave: half where nothing is hidden.
  constexpr double kHidden = 0.1;
  constexpr double kHarmless = 1e-3;  // of a period: known well enough whatever is hidden
  constexpr double kPoor = 0.05;      // of a period
  const std::string known = fmt::format("time offset known only to ± {:.2g} ms", 1e3 * u_s);
  if (share < kHidden && u_s > kHarmless * period_s) {
    return known +
           ": the motion lies in epipolar planes, where an offset looks like another depth; move "
           "the body across the plane of the cameras too";
  }
  return u_s > kPoor * period_s ? known + ": the body moves little" : "";
}

void AddInQuadrature(const Vector6d& part, std::optional<Vector6d>& u) {
  const Vector6d before = u.value_or(Vector6d::Zero());
  u = (before.array().square() + part.array().square()).sqrt().matrix();
}

/// Moves a frame's right points by what the body moves in the right image within the offset.
void MoveRightPoints(const MotionData& data, const Rigid3& now, const Rigid3& later,
                     MotionFrame& frame) {
  const RigCamera& right = data.rig.cameras[static_cast<std::size_t>(data.right_camera)];
  for (ImagePoint& point : frame.image_points) {
    if (point.camera != 1) continue;
    const Eigen::Vector3d& ball_mm = data.balls_in_body_mm[point.ball];
    const auto here_px = ProjectWorldPoint(right, now * ball_mm);
    const auto there_px = ProjectWorldPoint(right, later * ball_mm);
    if (here_px && there_px) point.center_px += *here_px - *there_px;
  }
}

/// Takes a frame out whose right points cannot be moved: nothing tells its velocity.
void MakeGap(MotionFrame& frame) {
  frame.image_points.clear();
  frame.space_points.clear();
  frame.pose.measured = false;
}

}  // namespace

std::optional<TimeOffset> EstimateTimeOffset(const MotionData& data) {
  constexpr double kSignificant = 4;       // σ: 1 in 15 000 recordings without offset
  constexpr double kUselessPeriods = 0.5;  // pairing by time says as much
  if (!SeenByBoth(data)) return std::nullopt;
  const OffsetProblem problem(data);
  if (problem.frames().empty()) return std::nullopt;
  const auto without = SolveOffset(problem, 0, /*fixed=*/true);
  const auto with = SolveOffset(problem, 0, /*fixed=*/false);
  if (!without || !with) return std::nullopt;
  const OffsetNormals& normals = with->normals;
  const auto solved = SolvePoses(normals, normals.cross);
  if (!solved) return std::nullopt;
  const double information = normals.offset_information - normals.cross.dot(solved->col(0));
  if (!(information > 0)) return std::nullopt;

  TimeOffset offset;
  offset.offset_s = with->offset_s;
  offset.u_s = 1 / std::sqrt(information);
  if (offset.u_s > kUselessPeriods * problem.period_s()) return std::nullopt;
  offset.chi2_without = without->normals.chi2;
  offset.chi2_with = normals.chi2;
  offset.dof = normals.rows - 6 * static_cast<int>(problem.frames().size()) - 1;
  // Where the residuals exceed the noise something else is not modelled; it must not pass for an
  // offset.
  const double scale = std::sqrt(std::max(1.0, offset.chi2_with / std::max(1, offset.dof)));
  offset.significant = std::abs(offset.offset_s) > kSignificant * scale * offset.u_s;
  offset.warning =
      Warning(offset.u_s, problem.period_s(), information / normals.offset_information);
  return offset;
}

MotionData WithTimeOffset(const MotionData& data, double offset_s, double u_s) {
  if (offset_s == 0 || !SeenByBoth(data)) return data;
  MotionData out = data;
  const OffsetProblem problem(data);
  const auto solution = SolveOffset(problem, offset_s, /*fixed=*/true);
  std::vector<bool> moved(data.frames.size(), false);
  const std::size_t count = solution ? problem.frames().size() : 0;
  const Eigen::VectorXd by_offset =
      solution ? Eigen::VectorXd(-*SolvePoses(solution->normals, solution->normals.cross))
               : Eigen::VectorXd();
  for (std::size_t k = 0; k < count; ++k) {
    const int row = static_cast<int>(k);
    MotionFrame& frame = out.frames[problem.frames()[k]];
    moved[problem.frames()[k]] = true;
    frame.pose.world_from_body = solution->poses[k];
    frame.pose.covariance = PoseCovariance(solution->normals, row);
    if (u_s > 0) AddInQuadrature(u_s * by_offset.segment<6>(6 * row), frame.pose.calibration_u);
    MoveRightPoints(data, solution->poses[k], problem.PoseAt(solution->poses, row, offset_s),
                    frame);
  }
  for (std::size_t i = 0; i < out.frames.size(); ++i) {
    if (!moved[i] && !out.frames[i].image_points.empty()) MakeGap(out.frames[i]);
  }
  return out;
}

}  // namespace stereomotion
