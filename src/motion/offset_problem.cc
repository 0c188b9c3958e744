#include "motion/offset_problem.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "motion/filter_segments.h"
#include "motion/path_stencil.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

constexpr int kMostNodes = OffsetNormals::kBand + 1;
constexpr int kFewestNodes = 3;         // velocity and acceleration
constexpr double kFarthestPeriods = 3;  // between neighbours: beyond, no polynomial is the path

/// Tells whether the image points determine a pose: three balls, with a row to spare.
bool DeterminePose(const MotionFrame& frame) {
  constexpr std::size_t kFewestPoints = 4, kFewestBalls = 3;
  std::set<int> balls;
  for (const ImagePoint& point : frame.image_points) balls.insert(point.ball);
  return frame.image_points.size() >= kFewestPoints && balls.size() >= kFewestBalls;
}

/// Adds a frame's Jacobian (rows by the poses of its stencil) to the band.
void AddToBand(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& by_offset,
               const Eigen::VectorXd& residuals, int first, OffsetNormals& normals) {
  const Eigen::MatrixXd square = jacobian.transpose() * jacobian;
  const int count = static_cast<int>(jacobian.cols()) / 6;
  for (int a = 0; a < count; ++a) {
    for (int b = a; b < count; ++b) {
      normals.hessian[first + a].block<6, 6>(0, 6 * (b - a)) += square.block<6, 6>(6 * a, 6 * b);
    }
  }
  normals.gradient.segment(6 * first, 6 * count) += jacobian.transpose() * residuals;
  normals.cross.segment(6 * first, 6 * count) += jacobian.transpose() * by_offset;
  normals.offset_information += by_offset.squaredNorm();
  normals.offset_gradient += by_offset.dot(residuals);
  normals.chi2 += residuals.squaredNorm();
}

/// Holds one frame's whitened rows.
struct FrameRows {
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd by_offset, residuals;
};

/// Linearises one point that is seen from a path's point; `later` is that of the right camera.
void LinearizePoint(const PointResidual& seen, const Eigen::Vector3d& rotated_mm,
                    const PathPoint& path, bool later, int self, int row, FrameRows& rows) {
  const Eigen::Matrix3d by_rotation = -seen.d_point * Hat(rotated_mm);
  rows.residuals.segment<3>(row) = seen.whitened;
  if (!later) {
    rows.jacobian.block<3, 3>(row, 6 * self) = by_rotation;
    rows.jacobian.block<3, 3>(row, 6 * self + 3) = seen.d_point;
    return;
  }
  for (std::size_t s = 0; s < path.weights.size(); ++s) {
    const int column = 6 * static_cast<int>(s);
    rows.jacobian.block<3, 3>(row, column) = by_rotation * path.by_rotation[s];
    rows.jacobian.block<3, 3>(row, column + 3) = path.weights[s] * seen.d_point;
  }
  rows.by_offset.segment<3>(row) =
      seen.d_point * (path.omega_rad_s.cross(rotated_mm) + path.velocity_mm_s);
}

}  // namespace

OffsetProblem::OffsetProblem(const MotionData& data) : data_(data) {
  const PoseSeries series = PosesOf(data);
  CheckSeries(series);
  period_s_ = MedianPeriodS(series);
  ChooseFrames();
  MakeStencils();
}

void OffsetProblem::ChooseFrames() {
  std::vector<std::size_t> run;
  const auto finish = [&] {
    if (run.size() >= kFewestNodes) frames_.insert(frames_.end(), run.begin(), run.end());
    run.clear();
  };
  for (std::size_t i = 0; i < data_.frames.size(); ++i) {
    const MotionFrame& frame = data_.frames[i];
    if (!frame.pose.measured || frame.pose.free_axis_in_world || !DeterminePose(frame)) continue;
    constexpr double kSecondsPerNs = 1e-9;
    const auto since = [&](std::size_t j) {
      return kSecondsPerNs *
             static_cast<double>(frame.pose.timestamp_ns - data_.frames[j].pose.timestamp_ns);
    };
    if (!run.empty() && since(run.back()) > kFarthestPeriods * period_s_) finish();
    run.push_back(i);
  }
  finish();
}

void OffsetProblem::MakeStencils() {
  constexpr double kSecondsPerNs = 1e-9;
  const int size = static_cast<int>(frames_.size());
  const auto after = [&](int j, int k) {
    return kSecondsPerNs * static_cast<double>(data_.frames[frames_[j]].pose.timestamp_ns -
                                               data_.frames[frames_[k]].pose.timestamp_ns);
  };
  int begin = 0, end = 0;  // of the run without long gaps
  for (int k = 0; k < size; ++k) {
    if (k == end) {
      begin = k;
      for (end = k + 1; end < size && after(end, end - 1) <= kFarthestPeriods * period_s_;) ++end;
    }
    const int count = std::min(kMostNodes, end - begin);
    PathStencil stencil;
    stencil.first = std::clamp(k - count / 2, begin, end - count);
    stencil.self = k - stencil.first;
    for (int s = 0; s < count; ++s) stencil.times_s.push_back(after(stencil.first + s, k));
    stencils_.push_back(stencil);
    MotionFrame image_only = data_.frames[frames_[k]];
    image_only.space_points.clear();
    points_.push_back(ObservationsOf(data_, image_only));
  }
}

std::vector<Rigid3> OffsetProblem::StartPoses() const {
  std::vector<Rigid3> poses;
  for (const std::size_t i : frames_) poses.push_back(data_.frames[i].pose.world_from_body);
  return poses;
}

Rigid3 OffsetProblem::PoseAt(const std::vector<Rigid3>& poses, int k, double offset_s) const {
  return EvaluatePath(stencils_[k], poses, offset_s).world_from_body;
}

std::optional<OffsetNormals> OffsetProblem::Linearize(const std::vector<Rigid3>& poses,
                                                      double offset_s) const {
  const int size = static_cast<int>(frames_.size());
  OffsetNormals normals;
  normals.hessian.assign(frames_.size(), OffsetNormals::BlockRow::Zero());
  normals.gradient = normals.cross = Eigen::VectorXd::Zero(6 * size);
  for (int k = 0; k < size; ++k) {
    const PathStencil& stencil = stencils_[k];
    const PathPoint path = EvaluatePath(stencil, poses, offset_s);
    const auto& image_points = data_.frames[frames_[k]].image_points;
    const int rows = 3 * static_cast<int>(image_points.size());
    FrameRows frame{Eigen::MatrixXd::Zero(rows, 6 * static_cast<int>(stencil.times_s.size())),
                    Eigen::VectorXd::Zero(rows), Eigen::VectorXd::Zero(rows)};
    for (std::size_t i = 0; i < image_points.size(); ++i) {
      const bool later = image_points[i].camera == 1;
      const Rigid3& pose = later ? path.world_from_body : poses[k];
      const Eigen::Vector3d rotated_mm =
          pose.rotation * data_.balls_in_body_mm[image_points[i].ball];
      const auto seen = Compare(points_[k][i], rotated_mm + pose.translation_mm);
      if (!seen) return std::nullopt;
      LinearizePoint(*seen, rotated_mm, path, later, stencil.self, 3 * static_cast<int>(i), frame);
      normals.rows += 2;
    }
    AddToBand(frame.jacobian, frame.by_offset, frame.residuals, stencil.first, normals);
  }
  return normals;
}

}  // namespace stereomotion
