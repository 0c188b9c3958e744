#pragma once

#include <Eigen/Core>
#include <cmath>

#include "stereomotion/simulation/sensor.h"

namespace stereomotion {

/// Computes how much of a unit square lies on the inner side of a straight edge at `distance` from
/// its middle (positive: the middle is inside). `normal`: unit normal of the edge.
double HalfPlaneCoverage(double distance, const Eigen::Vector2d& normal);

/// Holds light on a grid of cells, `cells_per_px` a pixel and axis, over a rectangle of the image
/// plane (it may lie beyond the image: blur carries light in).
class LightPatch {
 public:
  LightPatch(const Eigen::Vector2d& min_px, const Eigen::Vector2d& max_px, int cells_per_px);

  /// Adds the disc `rho(point_px) ≤ 1` to the cells: coverage × `light(point_px, rho)`.
  ///
  /// `rho` must grow outwards with a gradient between 1/max_radius and 1/`min_radius_px`. Cells at
  /// the limb are divided 4 × 4, each with the area cut off by the outline's tangent.
  template <class Rho, class Light>
  void AddDisc(double min_radius_px, const Rho& rho, const Light& light);

  /// Blurs the light and integrates it over the pixels of `image`.
  void AddTo(double blur_px, MeanImage& image) const;

  [[nodiscard]] Eigen::Vector2i origin_px() const { return origin_px_; }
  [[nodiscard]] Eigen::Vector2i size_px() const { return size_px_; }

 private:
  [[nodiscard]] Eigen::MatrixXd PixelWeights(int axis, double blur_px, int first, int count) const;
  [[nodiscard]] double CellSize() const { return 1.0 / cells_per_px_; }

  Eigen::Vector2i origin_px_;  ///< first pixel
  Eigen::Vector2i size_px_;
  int cells_per_px_;
  Eigen::MatrixXd cells_;  ///< mean light of each cell [DN]; row v, column u
};

template <class Rho, class Light>
void LightPatch::AddDisc(double min_radius_px, const Rho& rho, const Light& light) {
  constexpr int kParts = 4;
  const double size_px = CellSize();
  const double part_px = size_px / kParts;
  const auto limb_cell = [&](const Eigen::Vector2d& middle_px) {
    const Eigen::Vector2d du(size_px / 2, 0), dv(0, size_px / 2);
    const Eigen::Vector2d gradient = Eigen::Vector2d(rho(middle_px + du) - rho(middle_px - du),
                                                     rho(middle_px + dv) - rho(middle_px - dv)) /
                                     size_px;
    const double slope = gradient.norm();
    double sum = 0;
    for (int k = 0; k < kParts * kParts; ++k) {
      const int row = k / kParts, column = k % kParts;
      const Eigen::Vector2d offset((column + 0.5) * part_px - size_px / 2,
                                   (row + 0.5) * part_px - size_px / 2);
      const Eigen::Vector2d point_px = middle_px + offset;
      const double rho_here = rho(point_px);
      const double covered =
          HalfPlaneCoverage((1 - rho_here) / (slope * part_px), gradient / slope);
      if (covered > 0) sum += covered * light(point_px, std::fmin(rho_here, 1.0));
    }
    return sum / (kParts * kParts);
  };
  for (Eigen::Index col = 0; col < cells_.cols(); ++col) {
    for (Eigen::Index row = 0; row < cells_.rows(); ++row) {
      // Pixel (0, 0) reaches from −0.5 to 0.5.
      const Eigen::Vector2d middle_px(
          origin_px_.x() - 0.5 + (static_cast<double>(col) + 0.5) * size_px,
          origin_px_.y() - 0.5 + (static_cast<double>(row) + 0.5) * size_px);
      const double rho_here = rho(middle_px);
      if (std::fabs(1 - rho_here) * min_radius_px < size_px) {
        cells_(row, col) += limb_cell(middle_px);
      } else if (rho_here < 1) {
        cells_(row, col) += light(middle_px, rho_here);
      }
    }
  }
}

}  // namespace stereomotion
