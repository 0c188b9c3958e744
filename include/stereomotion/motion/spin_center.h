#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Says by which law the spin centre moves through the world.
enum class PathLaw {
  kFixed,        ///< order 0: it rests
  kUniform,      ///< order 1: constant velocity
  kAccelerated,  ///< order 2: constant acceleration
  kFree,         ///< any smooth path: does not tell the centre
};

/// Spells a law as motion.json does: fixed, uniform, accelerated, free.
std::string_view LawWord(PathLaw law);

/// Holds where the spin centre is at one time, in the world, and how it moves.
struct CenterState {
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_mm_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_mm_s2 = Eigen::Vector3d::Zero();
  /// Random covariance of (position, velocity, acceleration), from the joint fit.
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
  std::optional<Eigen::Vector3d> calibration_u_mm;  ///< common part, of the position
};

/// Holds the body point whose world path follows a law.
struct SpinCenter {
  PathLaw law = PathLaw::kFixed;
  Eigen::Vector3d in_body_mm = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_mm2 =
      Eigen::Matrix3d::Zero();  ///< random part; rank 2 with a free axis
  std::optional<Eigen::Matrix3d> calibration_covariance_mm2;
  /// The centre may lie anywhere along it (the body turned about one axis); `in_body_mm` is then
  /// the point nearest the balls' centroid.
  std::optional<Eigen::Vector3d> free_axis_in_body;
  std::vector<CenterState> states;  ///< one a frame of the data, gaps included
  std::vector<Rigid3> poses;        ///< world_from_body as refined jointly; of gaps: as given
};

/// Tells how well one law explains the data.
struct LawFit {
  PathLaw law = PathLaw::kFixed;
  double chi2 = 0;  ///< of all observations, under the law
  int dof = 0;
  double bic = 0;                    ///< Schwarz 1978, χ² + parameters · ln(observations)
  bool adequate = false;             ///< not refuted (F test against poses that follow no law)
  std::optional<SpinCenter> center;  ///< none where the law leaves it undetermined
  /// Share of the law where no law is known for sure (Akaike's weight; Burnham & Anderson 2002,
  /// sec. 2.9); 0 of a refuted law and of free.
  double weight = 0;
};

struct SpinCenterOptions {
  std::optional<PathLaw> law;   ///< given by the user; else chosen by evidence
  bool only_given_law = false;  ///< fit no law beside `law` (and free poses): no evidence, but fast
  /// With law free: power spectral density of the path's acceleration [mm²/s³] (white noise); then
  /// a centre is given, conditional on it.
  std::optional<double> path_psd_mm2_s3;
  double reject_sigma = 5;       ///< frames whose centre lies farther off the path are left out
  bool with_calibration = true;  ///< propagate the rig's and the structure's covariance
};

struct SpinCenterResult {
  PathLaw law = PathLaw::kFree;
  bool law_given = false;
  bool evidence_open = false;        ///< a narrower law explains the data about as well
  std::vector<LawFit> laws;          ///< fixed, uniform, accelerated, free
  std::optional<SpinCenter> center;  ///< by `law`; none where it is free or nothing is determined
  /// A cubic path explains the data much better than any law: the path is free.
  bool bends_otherwise = false;
  /// Of `center`, when the law is not known for sure: Σ w (C + d dᵀ) over all laws with their
  /// weights, d the way to their centre. None with the law given, and where a law that is likely
  /// enough (weight above 5 %) leaves the centre undetermined.
  std::optional<Eigen::Matrix3d> covariance_law_unknown_mm2;
  double range_of_rotation_rad = 0;  ///< largest angle between two poses
  std::vector<int> left_out;         ///< frames (indices) that contradict the law
  /// For a person, in words: "range of rotation 6.1°: centre known to ± 0.3 mm across the axis and
  /// not at all along it".
  std::string verdict;
};

/// Finds the point that a body turns about, and how that point moves.
///
/// The unknowns are, of every frame, the rotation R_t, and of all frames the centre c in the body
/// and the path's coefficients; the translation follows, t_t = p(t) − R_t c. Linear least squares
/// in the poses' covariances starts; Ceres minimises the whitened residuals of what was observed
/// (image points, space points or poses). Covariances come from the undamped normal equations with
/// the rotations (and an unknown structure) eliminated. They hold the second order of the
/// rotations' noise (errors in variables: A⁻¹ G A⁻¹ with the observed Hessian A and Gauss–Newton's
/// G), so they stay true where the range of rotation is only a few times the noise. Directions that
/// the motion leaves open are left out and named. Of one rod, whose roll nobody measures, the
/// centre is sought on the rod's own line. All laws are weighed on the same frames: `left_out` are
/// those that contradict the widest law in question. A cubic path is weighed beside the laws: where
/// it wins strongly the path is free, for the widest law takes the form of much that follows none.
/// With `path_psd_mm2_s3` the states' acceleration has infinite variance. Throws
/// std::invalid_argument for data that breaks its own rules (indices, times, covariances; unknown
/// balls on one line), and for `only_given_law` without a law.
SpinCenterResult FindSpinCenter(const MotionData& data, const SpinCenterOptions& options = {});

/// Averages the covariance of the centre's place in the world at one frame over the laws, as
/// `covariance_law_unknown_mm2` does in the body.
std::optional<Eigen::Matrix3d> PositionCovarianceLawUnknown(const SpinCenterResult& result,
                                                            std::size_t frame);

}  // namespace stereomotion
