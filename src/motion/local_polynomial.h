#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "stereomotion/geometry/rigid3.h"
#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Holds the measured poses of a stretch without long gaps.
struct PoseStretch {
  std::vector<std::size_t> indices;  ///< into the series
  std::vector<double> times_s;
  std::vector<Rigid3> poses;
  std::vector<Matrix6d> information;
  /// Unit of time of all polynomials [s]: keeps powers of different windows comparable.
  double unit_s = 1;
};

/// Highest degree that is fitted, and the orders beyond a fit's degree whose bias is known.
constexpr int kHighestDegree = 6, kBiasOrders = 3;

/// Gathers what a local polynomial fit needs of a window that grows about one time: moments of
/// time and information, Σ s^p Λ_t, and of the observations, Σ s^p Λ_t y_t, where y_t = (rotation
/// vector of R_t R_refᵀ, t_t − t_ref).
class WindowMoments {
 public:
  WindowMoments(const PoseStretch& stretch, double time_s, const Rigid3& reference);

  /// Adds one pose; false (and nothing added) where it is turned too far from the reference for its
  /// rotation vector to be smooth.
  bool Add(std::size_t i);

  const PoseStretch& stretch;
  double time_s;
  Rigid3 reference;
  int poses = 0;
  std::vector<Matrix6d> moments;
  std::vector<Vector6d> observed;

  /// What was added, pose by pose: χ² must be summed over residuals, for Σ yᵀ Λ y is 1e10 where
  /// the noise is 1e-5 of the motion, and rounding would be all that differences leave of it.
  struct Observation {
    double s;
    Vector6d y;
    Matrix6d information;
  };
  std::vector<Observation> observations;
};

/// Holds a polynomial (of the unit of time) about the window's time.
struct LocalPolynomial {
  int degree = 0;
  Eigen::VectorXd coefficients;  ///< order 0 (6), order 1 (6), …
  Eigen::MatrixXd covariance;
  int dof = 0;
  /// Error of the coefficients by the path's Taylor coefficients of order degree + 1, + 2, ….
  std::vector<Eigen::MatrixXd> bias_gains;
};

/// Fits a polynomial by weighted least squares. The window must hold more poses than `degree`.
LocalPolynomial FitLocalPolynomial(const WindowMoments& window, int degree);

/// Computes χ² of a fit to its window.
double Chi2Of(const LocalPolynomial& fit, const WindowMoments& window);

}  // namespace stereomotion
