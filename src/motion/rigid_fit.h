#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "stereomotion/geometry/rigid3.h"

namespace stereomotion {

using MarkerPoints = std::vector<Eigen::Vector3d>;

/// Fewer markers tell no rotation.
inline constexpr std::size_t kFewestMarkers = 3;

/// Tells a marker that was seen from one that was not (NaN).
inline bool Seen(const Eigen::Vector3d& point) { return point.allFinite(); }

/// Fits one rigid shape and every frame's pose on it to markers: generalised Procrustes alignment
/// (Gower 1975), of frames that show three markers or more that do not lie on a line.
class RigidFit {
 public:
  /// `frames` must outlive the fit.
  explicit RigidFit(const std::vector<MarkerPoints>& frames);

  /// Puts the shape's origin in its mean, and its axes as the world's in the first frame with a
  /// pose. False: no frame has one.
  bool SetFrame();

  /// Leaves out, and counts, frames that fit five times worse than the median one: no rigid motion,
  /// markers exchanged or slipped.
  int LeaveOutMisfits();

  [[nodiscard]] const MarkerPoints& shape() const { return shape_; }
  [[nodiscard]] const std::optional<Rigid3>& pose(std::size_t i) const { return poses_[i]; }
  [[nodiscard]] std::size_t CountPoses() const;

  /// Sums the squared distances [mm²], and counts the coordinates beyond the parameters.
  [[nodiscard]] std::pair<double, double> SquaresAndDof() const;

 private:
  void Refine();
  void AlignAll();
  double UpdateShape();
  [[nodiscard]] std::pair<Eigen::Matrix3Xd, Eigen::Matrix3Xd> Common(std::size_t i) const;
  [[nodiscard]] double Misfit_mm(std::size_t i) const;

  const std::vector<MarkerPoints>& frames_;
  MarkerPoints shape_;
  std::vector<bool> used_;
  std::vector<std::optional<Rigid3>> poses_;
};

}  // namespace stereomotion
