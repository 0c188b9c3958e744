#pragma once

#include <Eigen/Core>
#include <array>

namespace stereomotion {

/// Says how black and white meet at a corner.
enum class CornerShape {
  kWedge,  ///< the corner of a black area on white
  kSaddle  ///< two black areas touch at their corners, as on a chessboard
};

/// Models the grey values around a corner between two edges, blurred by a Gaussian; the pixel's
/// square aperture counts as part of it (variance 1/12 px²).
///
/// The black share at a pixel is the probability that two correlated normal numbers lie on the
/// black sides of both edges: exact for straight edges at any angle. The light may slope.
struct CornerModel {
  /// `kAngle0`, `kAngle1`: of the edges' arms, from +u towards +v.
  enum Parameter { kU, kV, kAngle0, kAngle1, kBlur, kBlack, kWhite, kSlopeU, kSlopeV };
  static constexpr int kNumParameters = 9;
  using Vector = Eigen::Matrix<double, kNumParameters, 1>;
  using Matrix = Eigen::Matrix<double, kNumParameters, kNumParameters>;

  CornerShape shape = CornerShape::kWedge;
  Vector values = Vector::Zero();  ///< px, rad, px, DN, 1/px
  /// Curvature vectors of the edges [1/px]: known, not estimated.
  std::array<Eigen::Vector2d, 2> curvature = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  Eigen::Vector2d origin_px = Eigen::Vector2d::Zero();  ///< where the light is 1

  [[nodiscard]] Eigen::Vector2d corner_px() const { return {values[kU], values[kV]}; }
};

/// Predicts grey values of one `CornerModel`.
class CornerPredictor {
 public:
  explicit CornerPredictor(const CornerModel& model);

  /// Grey value at a pixel [DN]; `gradient` receives its derivatives by `CornerModel::values`.
  double Grey(const Eigen::Vector2d& pixel_px, CornerModel::Vector* gradient) const;

  /// Unit vector along an edge's arm.
  [[nodiscard]] const Eigen::Vector2d& Arm(int edge) const { return edges_[edge].arm; }
  /// Unit normal of an edge, towards the other edge's arm: into the wedge's black.
  [[nodiscard]] const Eigen::Vector2d& Normal(int edge) const { return edges_[edge].normal; }
  /// Correlation of the blur across both edges: the cosine between their normals.
  [[nodiscard]] double rho() const { return rho_; }

 private:
  struct Edge {
    Eigen::Vector2d arm, normal;
    double bend = 0;     ///< curvature towards `normal` [1/px]
    double stretch = 0;  ///< curvature along `arm` [1/px]
    double turn = 0;     ///< ±1: d normal / d angle = −turn · arm
  };
  /// An edge as one pixel sees it; distances in blur widths, inwards.
  struct Sight {
    double distance = 0, d_angle = 0;
    Eigen::Vector2d d_corner;
  };
  [[nodiscard]] Sight Look(const Edge& edge, const Eigen::Vector2d& from_corner_px) const;

  CornerModel model_;
  Edge edges_[2];
  double rho_ = 0;
};

}  // namespace stereomotion
