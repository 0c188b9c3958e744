#include "rigid_fit.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "stereomotion/core/median.h"

namespace stereomotion {
namespace {

using Points = MarkerPoints;

Eigen::Matrix3Xd Columns(const Points& points) {
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    columns.col(static_cast<Eigen::Index>(i)) = points[i];
  }
  return columns;
}

// Points on a line leave the roll about it open; a thousandth of the length is less than a marker.
bool OnOneLine(const Eigen::Matrix3Xd& points) {
  constexpr double kFlat = 1e-3;
  const Eigen::Matrix3Xd centred = points.colwise() - points.rowwise().mean();
  const Eigen::Vector3d size = centred.jacobiSvd().singularValues();
  return size[1] <= kFlat * size[0];
}

}  // namespace

RigidFit::RigidFit(const std::vector<Points>& frames) : frames_(frames) {
  const auto seen = [](const Points& frame) {
    return std::count_if(frame.begin(), frame.end(), Seen);
  };
  const auto most =
      std::max_element(frames.begin(), frames.end(),
                       [&](const Points& a, const Points& b) { return seen(a) < seen(b); });
  shape_ = *most;
  used_.assign(frames.size(), true);
  Refine();
}

// Alternates until the shape rests; clusters do so in a few rounds.
void RigidFit::Refine() {
  constexpr int kRounds = 100;
  constexpr double kRest_mm = 1e-9;
  for (int round = 0; round < kRounds; ++round) {
    AlignAll();
    if (UpdateShape() < kRest_mm) break;
  }
  AlignAll();
}

// Origin in the mean, axes as the world's in the first frame with a pose.
bool RigidFit::SetFrame() {
  const auto first =
      std::find_if(poses_.begin(), poses_.end(), [](const auto& p) { return p.has_value(); });
  if (first == poses_.end()) return false;
  const Eigen::Quaterniond turn = (*first)->rotation;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  int count = 0;
  for (const auto& point : shape_) {
    if (!Seen(point)) continue;
    mean += point;
    ++count;
  }
  mean /= std::max(count, 1);
  for (auto& point : shape_) point = turn * (point - mean);
  AlignAll();
  return true;
}

// Frames five times worse than the median one are no rigid motion: markers exchanged or slipped.
int RigidFit::LeaveOutMisfits() {
  std::vector<double> misfits;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (poses_[i]) misfits.push_back(Misfit_mm(i));
  }
  if (misfits.empty()) return 0;
  constexpr double kWorse = 5;
  const double limit_mm = kWorse * Median(std::move(misfits));
  int count = 0;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (!poses_[i] || Misfit_mm(i) <= limit_mm || limit_mm <= 0) continue;
    used_[i] = false;
    ++count;
  }
  if (count > 0) Refine();
  return count;
}

// Sum of squares and how many coordinates it has beyond the parameters.
std::pair<double, double> RigidFit::SquaresAndDof() const {
  double squares = 0, dof = 0;
  constexpr double kGauge = 6;
  dof += kGauge;
  for (const auto& point : shape_) dof -= Seen(point) ? 3 : 0;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (!poses_[i]) continue;
    const double n = static_cast<double>(Common(i).first.cols());
    squares += n * std::pow(Misfit_mm(i), 2);
    dof += 3 * n - kGauge;
  }
  return {squares, dof};
}

std::size_t RigidFit::CountPoses() const {
  return static_cast<std::size_t>(std::count_if(poses_.begin(), poses_.end(),
                                                [](const auto& pose) { return pose.has_value(); }));
}

// Markers that shape and frame both know.
std::pair<Eigen::Matrix3Xd, Eigen::Matrix3Xd> RigidFit::Common(std::size_t i) const {
  Points body, world;
  for (std::size_t k = 0; k < shape_.size(); ++k) {
    if (!Seen(shape_[k]) || !Seen(frames_[i][k])) continue;
    body.push_back(shape_[k]);
    world.push_back(frames_[i][k]);
  }
  return {Columns(body), Columns(world)};
}

void RigidFit::AlignAll() {
  poses_.assign(frames_.size(), std::nullopt);
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (!used_[i]) continue;
    const auto [body, world] = Common(i);
    if (static_cast<std::size_t>(body.cols()) < kFewestMarkers || OnOneLine(body)) continue;
    poses_[i] = AlignPoints(body, world);
  }
}

// Largest way of a marker.
double RigidFit::UpdateShape() {
  Points sums(shape_.size(), Eigen::Vector3d::Zero());
  std::vector<int> counts(shape_.size(), 0);
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (!poses_[i]) continue;
    const Rigid3 body_from_world = poses_[i]->Inverse();
    for (std::size_t k = 0; k < shape_.size(); ++k) {
      if (!Seen(frames_[i][k])) continue;
      sums[k] += body_from_world * frames_[i][k];
      ++counts[k];
    }
  }
  double way_mm = 0;
  for (std::size_t k = 0; k < shape_.size(); ++k) {
    if (counts[k] == 0) continue;
    const Eigen::Vector3d mean = sums[k] / counts[k];
    way_mm = std::max(way_mm, Seen(shape_[k]) ? (mean - shape_[k]).norm() : 1);
    shape_[k] = mean;
  }
  return way_mm;
}

double RigidFit::Misfit_mm(std::size_t i) const {
  const auto [body, world] = Common(i);
  double squares = 0;
  for (Eigen::Index k = 0; k < body.cols(); ++k) {
    squares += (*poses_[i] * Eigen::Vector3d(body.col(k)) - world.col(k)).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(body.cols()));
}

}  // namespace stereomotion
