#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stereomotion/camera/rig.h"

namespace stereomotion {

/// Holds the image of one point, for the fits that labelling needs.
struct PointImage {
  Eigen::Vector3d p_mm;
  Eigen::Vector2d pixel_px;
};

/// Says what of a camera is estimated besides its pose; each includes those before it.
enum class CameraFreedom {
  kFocal,           ///< one focal length
  kPrincipalPoint,  ///< and the principal point
  kDistortion       ///< and fx, fy apart, k1, k2, p1, p2
};

/// Holds a camera that predicts where points appear.
struct LabelCamera {
  RigCamera camera;
  double rms_px = 0;  ///< of the points that it was fitted to, per coordinate, robust
  /// Covariance of the 15 rig parameters for errors of `rms_px`; weak priors included.
  Eigen::Matrix<double, RigParameter::kPerCamera, RigParameter::kPerCamera> covariance;

  /// Predicts a point's place; `sigma_px` receives the larger standard deviation of it.
  std::optional<Eigen::Vector2d> Predict(const Eigen::Vector3d& p_mm,
                                         double* sigma_px = nullptr) const;
};

/// Fits a camera of square pixels to ≥ 4 points, not all in a plane, from nothing: scaled
/// orthography gives the start for several focal lengths. `sigma_px`: about how well the pixels are
/// known; points farther off count less (Cauchy). Nothing where no such camera fits.
std::optional<LabelCamera> StartCamera(const std::vector<PointImage>& points, int width_px,
                                       int height_px, double sigma_px);

/// Improves a camera by Levenberg–Marquardt with Cauchy's weights of scale `sigma_px`.
///
/// Weak priors (principal point near the middle, nearly square pixels, little distortion) keep what
/// few points do not tell where real lenses are: this camera only predicts, it is no calibration.
/// False: the fit failed, `camera` is unchanged.
bool RefineCamera(const std::vector<PointImage>& points, CameraFreedom freedom, double sigma_px,
                  LabelCamera& camera);

}  // namespace stereomotion
