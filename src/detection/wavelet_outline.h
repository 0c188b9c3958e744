#pragma once

#include <array>
#include <vector>

#include "wavelet_ellipse.h"
#include "wavelet_locator.h"
#include "wavelet_patch.h"
#include "wavelet_steepness.h"
#include "wavelet_transform.h"

namespace stereomotion {

/// Holds the outline of one ball and how well it is known.
struct Outline {
  Ellipse ellipse;  ///< in pixels of the patch
  Eigen::Matrix2d center_covariance_px2 = Eigen::Matrix2d::Zero();
  double chi2_dof = 0;         ///< squared distances of the edge points against what noise explains
  double dof = 0;              ///< of independent edge points, about
  double visible_share = 0;    ///< of the outline on which edge points were found that belong to it
  double blur_px = 0;          ///< of the image, pixel aperture included
  double rms_distance_px = 0;  ///< of the edge points used
  double steepness_wave = 0;   ///< amplitude of two waves of the slope around it; 1: its mean
};

/// Fits an ellipse to edge points that it finds itself along the ellipse's normals. Keeps its
/// memory.
///
/// Points that noise does not explain are rejected together with their neighbours within the
/// filters' reach; the others count alike. The covariance follows every pixel's noise through
/// filters, edge points and fit: with x = (JᵀJ)⁻¹Jᵀ t and t = F n, it is computed as a sum over the
/// pixels of (their influence on x)² × variance, so that neighbouring edge points, which share
/// pixels, are correlated as they are.
class OutlineFitter {
 public:
  /// Starts from `initial`; false where no ellipse emerges. `edge_variance_dn2` is that of a pixel
  /// at the limb.
  bool Fit(const WaveletTransform& transform, const WaveletPatch& patch, const Ellipse& initial,
           double edge_variance_dn2, Outline& outline);

 private:
  struct Ray {
    LocatedEdge edge;
    Ellipse::Vector jacobian = Ellipse::Vector::Zero();
    double sigma_px = 0;
    double slope_sigma_dn_px = 0;
    double distance_px = 0;
    bool is_used = false;
  };
  void CastRays(const WaveletTransform& transform, const Ellipse& ellipse, double reach_px,
                double edge_variance_dn2);
  /// Fits the used points by least squares, linearised at the ellipse the rays were cast from.
  bool Solve(Ellipse::Vector& step, Ellipse::Matrix& inverse_normal);
  /// Rejects the points furthest off; false where none lies further than `sigmas` of its noise and
  /// `slack_px`.
  bool RejectOutliers(double sigmas, double slack_px);
  [[nodiscard]] bool IsExplained() const;
  double MedianShift();
  void RejectUnlike();
  void RejectNeighbours(double radius_px);
  bool RefitWithoutOutliers(double sigmas, double slack_px, Ellipse::Vector& step,
                            Ellipse::Matrix& inverse_normal);
  bool FitRays(bool is_rough, double radius_px, Ellipse::Vector& step,
               Ellipse::Matrix& inverse_normal);
  /// Computes the centre's covariance by way of each pixel's influence on it.
  Eigen::Matrix2d PropagateNoise(const WaveletPatch& patch, const Ellipse::Matrix& inverse_normal);
  void Summarise(const Ellipse::Matrix& inverse_normal, Outline& outline) const;
  EdgeLocator locator_;
  std::vector<Ray> rays_;
  SteepnessWaves steepness_;
  std::vector<char> doubtful_;
  std::vector<double> shifts_px_;
  std::vector<EdgeSteepness> slopes_;
  WaveletTransform adjoint_;
  std::array<WaveletWeights, 2> weights_;  ///< of u and v
  std::array<WaveletPlane, 2> influence_;  ///< of the pixels on u and v
};

}  // namespace stereomotion
