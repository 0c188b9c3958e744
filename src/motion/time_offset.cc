#include "stereomotion/motion/time_offset.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "motion/common_errors.h"
#include "motion/filter_segments.h"
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

/// Holds what one set of common errors says of the offset.
struct Estimate {
  TimeOffset offset;
  double share = 0;  ///< of the right camera's information that poses and errors leave
};

double Scale(const TimeOffset& offset) {
  return std::sqrt(std::max(1.0, offset.chi2_with / std::max(1, offset.dof)));
}

/// Fits offset, poses and common errors. The estimate is linear in the errors of variance one, so
/// their row of the inverse information is how much of its variance each makes.
std::optional<Estimate> Fit(const MotionData& data, const CommonErrors& errors) {
  constexpr double kUselessPeriods = 0.5;  // pairing by time says as much
  const OffsetProblem problem(data, errors);
  if (problem.frames().empty()) return std::nullopt;
  const auto without = SolveOffset(problem, 0, /*fixed=*/true);
  const auto with = SolveOffset(problem, 0, /*fixed=*/false);
  if (!without || !with) return std::nullopt;
  const auto information = SharedInformation(with->normals);
  if (!information) return std::nullopt;
  const Eigen::LLT<Eigen::MatrixXd> factor(*information);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::VectorXd row = factor.solve(Eigen::VectorXd::Unit(information->rows(), 0));
  const double common_s2 = row.tail(row.size() - 1).squaredNorm();
  if (!(row[0] > common_s2) || std::sqrt(row[0]) > kUselessPeriods * problem.period_s()) {
    return std::nullopt;
  }
  Estimate estimate;
  TimeOffset& offset = estimate.offset;
  offset.offset_s = with->at.offset_s;
  offset.u_s = std::sqrt(row[0] - common_s2);
  offset.calibration_u_s = std::sqrt(common_s2);
  offset.chi2_without = without->normals.chi2;
  offset.chi2_with = with->normals.chi2;
  offset.dof = with->normals.rows - 6 * static_cast<int>(problem.frames().size()) - 1;
  estimate.share = 1 / (row[0] * with->normals.information(0, 0));
  return estimate;
}

/// Beyond `kSignificant` standard uncertainties: 1 in 15 000 recordings without offset. They are
/// widened where the residuals exceed the noise: what else is not modelled is no offset.
bool StandsOut(const TimeOffset& offset, double scale) {
  constexpr double kSignificant = 4;
  return std::abs(offset.offset_s) >
         kSignificant * scale * std::hypot(offset.u_s, offset.calibration_u_s);
}

/// Tells whether noise explains what is left.
bool AtNoiseLevel(const TimeOffset& offset) {
  constexpr double kNoiseLevel = 2;  // χ²/dof: noise that was stated 40 % too small
  return offset.chi2_with < kNoiseLevel * offset.dof;
}

/// Tells whether the misfit is gone with the offset, or most of it.
bool Explains(const TimeOffset& offset, double chi2_without) {
  constexpr double kLittle = 0.1;  // of the misfit
  return AtNoiseLevel(offset) || offset.chi2_with < kLittle * chi2_without;
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

/// Says why an offset that stands out is not taken for one.
std::string Doubt(const TimeOffset& stated, bool explained) {
  constexpr double kMsPerS = 1000;
  const std::string claim =
      fmt::format("taken alone, a right camera {:.3g} ms late would lessen the misfit, but ",
                  kMsPerS * stated.offset_s);
  return claim + (explained ? "so would a rig that is a little wrong, and this one states no "
                              "covariance: no offset is corrected"
                            : fmt::format("χ²/dof {:.3g} is left: check the rig; no offset is "
                                          "corrected",
                                          stated.chi2_with / std::max(1, stated.dof)));
}

/// Decides with a rig that may be wrong by far more than it states: only an offset that even so
/// stands out is one. Its value is the stated rig's where that is not refuted.
TimeOffset DecideWithLooseRig(const MotionData& data, const CommonErrors& stated_errors,
                              TimeOffset stated) {
  const double misfit = stated.chi2_without;
  const bool explained = AtNoiseLevel(stated);
  const auto loose = Fit(data, LoosenRig(data, stated_errors));
  const bool stands =
      loose && Explains(loose->offset, misfit) && StandsOut(loose->offset, Scale(loose->offset));
  TimeOffset decided = explained || !loose ? stated : loose->offset;
  decided.significant = stands;
  decided.chi2_without = misfit;
  if (!stands && StandsOut(stated, 1)) decided.warning = Doubt(stated, explained);
  return decided;
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
  if (!SeenByBoth(data)) return std::nullopt;
  const CommonErrors errors = StatedErrors(data);
  const auto stated = Fit(data, errors);
  if (!stated) return std::nullopt;
  TimeOffset offset = stated->offset;
  offset.significant = StandsOut(offset, Scale(offset));
  const double u_s = std::hypot(offset.u_s, offset.calibration_u_s);
  offset.warning = Warning(u_s, MedianPeriodS(PosesOf(data)), stated->share);
  if (!AtNoiseLevel(offset) || (offset.significant && !data.rig.covariance)) {
    offset = DecideWithLooseRig(data, errors, offset);
  }
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
      solution ? Eigen::VectorXd(-*SolvePoses(solution->normals, solution->normals.cross.col(0)))
               : Eigen::VectorXd();
  for (std::size_t k = 0; k < count; ++k) {
    const int row = static_cast<int>(k);
    MotionFrame& frame = out.frames[problem.frames()[k]];
    moved[problem.frames()[k]] = true;
    frame.pose.world_from_body = solution->at.poses[k];
    frame.pose.covariance = PoseCovariance(solution->normals, row);
    if (u_s > 0) AddInQuadrature(u_s * by_offset.segment<6>(6 * row), frame.pose.calibration_u);
    MoveRightPoints(data, solution->at.poses[k], problem.PoseAt(solution->at.poses, row, offset_s),
                    frame);
  }
  for (std::size_t i = 0; i < out.frames.size(); ++i) {
    if (!moved[i] && !out.frames[i].image_points.empty()) MakeGap(out.frames[i]);
  }
  return out;
}

}  // namespace stereomotion
