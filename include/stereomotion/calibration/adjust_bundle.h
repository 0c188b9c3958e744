#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "stereomotion/camera/rig.h"
#include "stereomotion/core/expected.h"

namespace stereomotion {

/// Says what of a view's `world_from_target` is estimated.
enum class PoseFreedom {
  kFixed,  ///< nothing: the target defines the world
  kFree,   ///< all six
  kLine    ///< all but the turn about the target's x axis, which a wand's balls leave free
};

struct BundleView {
  Rigid3 world_from_target;
  PoseFreedom freedom = PoseFreedom::kFree;
};

/// Holds a point of the target. Each axis: σ = 0 keeps the coordinate, a finite σ makes
/// `surveyed_mm` an observation of it, an infinite one leaves it free.
struct BundlePoint {
  Eigen::Vector3d xyz_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d surveyed_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d sigma_mm = Eigen::Vector3d::Zero();
  double ball_radius_mm = 0;    ///< the outline of a ball is observed; 0: no ball
  double circle_radius_mm = 0;  ///< the outline of a circle in the target's xy plane is observed
};

/// Holds one observed image point.
struct BundleObservation {
  int camera = 0, view = 0, point = 0;
  Eigen::Vector2d pixel_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Identity();
  bool used = true;
};

/// Holds what is known of the cameras beforehand: an earlier calibration as an observation of the
/// parameters that its covariance names (normally distributed about `mean`).
struct BundlePrior {
  std::vector<RigCamera> mean;  ///< as many as the problem's cameras
  RigCovariance covariance;     ///< positive definite; of parameters that are estimated
};

/// Describes a bundle adjustment: N cameras see a target in several views. The start values are
/// part of it; what fixes the world (gauge) is a fixed view, a fixed camera or surveyed points.
struct BundleProblem {
  std::vector<RigCamera> cameras;
  /// Which unknown each of a camera's nine intrinsics is, −1: kept. Equal numbers are one unknown:
  /// fx and fy of a camera, or a focal length shared by cameras. Numbered from 0 without gaps.
  std::vector<std::array<int, CameraModel::kNumParameters>> intrinsic_unknown;
  std::vector<bool> camera_fixed;  ///< keep cam_from_world
  std::vector<BundleView> views;
  std::vector<BundlePoint> points;
  std::vector<BundleObservation> observations;
  std::optional<BundlePrior> prior;
};

struct BundleOptions {
  int max_iterations = 100;
  /// Huber's threshold on a whitened residual's length; infinite: plain least squares.
  double huber = std::numeric_limits<double>::infinity();
  bool with_covariance = true;
};

/// Holds the adjusted state with its covariance. The covariance is that of the stated observation
/// covariances, never damped, scaled or truncated.
struct BundleSolution {
  std::vector<RigCamera> cameras;
  std::vector<BundleView> views;
  std::vector<BundlePoint> points;
  std::vector<Eigen::Vector2d> residuals_px;  ///< observed − predicted, of every observation
  std::vector<double> normalized;             ///< whitened length; infinite: no projection
  double image_chi2 = 0;                      ///< of the used observations
  double survey_chi2 = 0;                     ///< of the points' surveyed coordinates
  double prior_chi2 = 0;                      ///< of the cameras' prior
  /// Redundancies (observations less what they determine), which the χ² are expected to equal.
  double image_redundancy = 0, survey_redundancy = 0, prior_redundancy = 0;
  RigCovariance rig_covariance;  ///< of all estimated parameters of the cameras
  std::vector<Eigen::Matrix3d> point_covariance_mm2;
  int iterations = 0;
};

/// Says why an adjustment has no answer.
struct BundleFailure {
  enum class Reason {
    kNoConvergence,
    kUndetermined,  ///< the observations leave a direction free
    kTooFewObservations
  } reason;
  std::vector<std::string> parameters;  ///< kUndetermined: those that the free direction moves most
};

/// Adjusts cameras, views and points together to the observations: maximum likelihood by
/// Levenberg–Marquardt, views (or points, where all views are fixed) eliminated by Schur's
/// complement (Triggs et al. 2000, sec. 6). Where a used observation's point cannot be
/// projected from the start values there is no convergence. A prior of parameters that are not
/// estimated, or whose covariance is not positive definite, throws std::invalid_argument.
Expected<BundleSolution, BundleFailure> AdjustBundle(const BundleProblem& problem,
                                                     const BundleOptions& options = {});

}  // namespace stereomotion
