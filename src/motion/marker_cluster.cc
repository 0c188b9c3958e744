#include "stereomotion/motion/marker_cluster.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

using Points = std::vector<Eigen::Vector3d>;
constexpr std::size_t kFewestMarkers = 3;

bool Seen(const Eigen::Vector3d& point) { return point.allFinite(); }

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

// The mean shape and every frame's pose on it.
class RigidFit {
 public:
  explicit RigidFit(const std::vector<Points>& frames) : frames_(frames) {
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
  void Refine() {
    constexpr int kRounds = 100;
    constexpr double kRest_mm = 1e-9;
    for (int round = 0; round < kRounds; ++round) {
      AlignAll();
      if (UpdateShape() < kRest_mm) break;
    }
    AlignAll();
  }

  // Origin in the mean, axes as the world's in the first frame with a pose.
  bool SetFrame() {
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
  int LeaveOutMisfits() {
    std::vector<double> misfits;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      if (poses_[i]) misfits.push_back(Misfit_mm(i));
    }
    if (misfits.empty()) return 0;
    const auto middle = misfits.begin() + static_cast<std::ptrdiff_t>(misfits.size() / 2);
    std::nth_element(misfits.begin(), middle, misfits.end());
    constexpr double kWorse = 5;
    const double limit_mm = kWorse * *middle;
    int count = 0;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      if (!poses_[i] || Misfit_mm(i) <= limit_mm || limit_mm <= 0) continue;
      used_[i] = false;
      ++count;
    }
    if (count > 0) Refine();
    return count;
  }

  [[nodiscard]] const Points& shape() const { return shape_; }
  [[nodiscard]] const std::optional<Rigid3>& pose(std::size_t i) const { return poses_[i]; }

  // Sum of squares and how many coordinates it has beyond the parameters.
  [[nodiscard]] std::pair<double, double> SquaresAndDof() const {
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

  [[nodiscard]] std::size_t CountPoses() const {
    return static_cast<std::size_t>(std::count_if(
        poses_.begin(), poses_.end(), [](const auto& pose) { return pose.has_value(); }));
  }

 private:
  // Markers that shape and frame both know.
  [[nodiscard]] std::pair<Eigen::Matrix3Xd, Eigen::Matrix3Xd> Common(std::size_t i) const {
    Points body, world;
    for (std::size_t k = 0; k < shape_.size(); ++k) {
      if (!Seen(shape_[k]) || !Seen(frames_[i][k])) continue;
      body.push_back(shape_[k]);
      world.push_back(frames_[i][k]);
    }
    return {Columns(body), Columns(world)};
  }

  void AlignAll() {
    poses_.assign(frames_.size(), std::nullopt);
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      if (!used_[i]) continue;
      const auto [body, world] = Common(i);
      if (static_cast<std::size_t>(body.cols()) < kFewestMarkers || OnOneLine(body)) continue;
      poses_[i] = AlignPoints(body, world);
    }
  }

  // Largest way of a marker.
  double UpdateShape() {
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

  [[nodiscard]] double Misfit_mm(std::size_t i) const {
    const auto [body, world] = Common(i);
    double squares = 0;
    for (Eigen::Index k = 0; k < body.cols(); ++k) {
      squares += (*poses_[i] * Eigen::Vector3d(body.col(k)) - world.col(k)).squaredNorm();
    }
    return std::sqrt(squares / static_cast<double>(body.cols()));
  }

  const std::vector<Points>& frames_;
  Points shape_;
  std::vector<bool> used_;
  std::vector<std::optional<Rigid3>> poses_;
};

void CheckMarkers(const MarkerSeries& markers) {
  if (!(markers.rate_hz > 0)) throw std::invalid_argument("MakeCluster: the rate is not positive");
  for (const Points& frame : markers.points_mm) {
    if (frame.size() != markers.points_mm.front().size()) {
      throw std::invalid_argument("MakeCluster: frames have different numbers of markers");
    }
  }
}

// Inverse information of the markers of one frame about its pose.
Matrix6d PoseCovariance(const Rigid3& pose, const std::vector<SpacePoint>& points,
                        const Points& shape, double sigma_mm) {
  Matrix6d information = Matrix6d::Zero();
  for (const SpacePoint& point : points) {
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian << -Hat(pose.rotation * shape[static_cast<std::size_t>(point.ball)]),
        Eigen::Matrix3d::Identity();
    information += jacobian.transpose() * jacobian / (sigma_mm * sigma_mm);
  }
  return information.llt().solve(Matrix6d::Identity());
}

MotionFrame MakeFrame(const MarkerSeries& markers, const RigidFit& fit, std::size_t i,
                      double sigma_mm) {
  constexpr double kNsPerS = 1e9;
  MotionFrame frame;
  frame.pose.frame = markers.first_frame + static_cast<std::int64_t>(i);
  frame.pose.timestamp_ns = std::llround(kNsPerS * static_cast<double>(i) / markers.rate_hz);
  if (!fit.pose(i)) return frame;
  frame.pose.measured = true;
  frame.pose.world_from_body = *fit.pose(i);
  for (std::size_t k = 0; k < fit.shape().size(); ++k) {
    if (!Seen(markers.points_mm[i][k]) || !Seen(fit.shape()[k])) continue;
    frame.space_points.push_back({static_cast<int>(k), markers.points_mm[i][k],
                                  sigma_mm * sigma_mm * Eigen::Matrix3d::Identity()});
  }
  frame.pose.covariance = PoseCovariance(*fit.pose(i), frame.space_points, fit.shape(), sigma_mm);
  return frame;
}

// Markers that no frame with a pose shows have no place in the body.
void TakeSeenMarkers(const Points& shape, MotionData& data) {
  std::vector<int> index(shape.size(), -1);
  for (std::size_t k = 0; k < shape.size(); ++k) {
    if (!Seen(shape[k])) continue;
    index[k] = static_cast<int>(data.balls_in_body_mm.size());
    data.balls_in_body_mm.push_back(shape[k]);
  }
  for (MotionFrame& frame : data.frames) {
    for (SpacePoint& point : frame.space_points) {
      point.ball = index[static_cast<std::size_t>(point.ball)];
    }
  }
}

}  // namespace

Expected<MarkerCluster, ClusterFailure> MakeCluster(const MarkerSeries& markers, double sigma_mm) {
  CheckMarkers(markers);
  if (markers.points_mm.empty()) return Unexpected{ClusterFailure::kTooFewFrames};
  if (markers.points_mm.front().size() < kFewestMarkers) {
    return Unexpected{ClusterFailure::kTooFewMarkers};
  }
  RigidFit fit(markers.points_mm);
  MarkerCluster cluster;
  cluster.not_rigid = fit.LeaveOutMisfits();
  if (!fit.SetFrame()) return Unexpected{ClusterFailure::kTooFewMarkers};
  if (fit.CountPoses() < 2) return Unexpected{ClusterFailure::kTooFewFrames};
  const auto [squares, dof] = fit.SquaresAndDof();
  constexpr double kLeast_mm = 1e-9;  // exact points: what the numbers of a file leave
  cluster.sigma_mm =
      sigma_mm > 0 ? sigma_mm : std::max(kLeast_mm, std::sqrt(squares / std::max(dof, 1.0)));
  cluster.data.structure_known = false;
  double points = 0;
  for (std::size_t i = 0; i < markers.points_mm.size(); ++i) {
    cluster.data.frames.push_back(MakeFrame(markers, fit, i, cluster.sigma_mm));
    points += static_cast<double>(cluster.data.frames.back().space_points.size());
  }
  TakeSeenMarkers(fit.shape(), cluster.data);
  cluster.rms_mm = std::sqrt(squares / std::max(points, 1.0));
  return cluster;
}

}  // namespace stereomotion
