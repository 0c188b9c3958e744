#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stereomotion/motion/motion_data.h"
#include "stereomotion/motion/velocity.h"

namespace stereomotion {

enum class FilterMethod {
  kButterworth,  ///< zero-phase, cut-off corrected for the two passes
  kSpline,       ///< smoothing spline, generalised cross-validation
  kRts,          ///< Rauch–Tung–Striebel smoother on SE(3)
};

struct FilterOptions {
  FilterMethod method = FilterMethod::kButterworth;
  double cutoff_hz = 6;  ///< Butterworth: −3 dB of BOTH passes together (Winter 2009)
  int order = 4;         ///< Butterworth: of both passes together; even
  /// RTS: power spectral densities of the acceleration's noise; nothing: estimated from the data
  /// (maximum likelihood of the innovations).
  std::optional<double> rotation_psd_rad2_s3, translation_psd_mm2_s3;
  double max_gap_s = 0.1;  ///< shorter gaps are filled and flagged, longer ones left empty
};

/// Holds one frame of a filtered series.
struct FilteredSample {
  MotionStatus status = MotionStatus::kGap;
  PoseSample pose;  ///< smoothed; covariance of the filtered value (correlated from frame to frame)
  BodyVelocity velocity;
};

struct FilteredSeries {
  std::vector<FilteredSample> samples;  ///< one a frame
  std::string description;  ///< the filter with all its numbers, for run.json and for people
};

/// Smooths a series of poses. Rotations are filtered as rotation vectors against a slowly moving
/// reference, so no angle wraps. Random covariances are propagated through the filter, which is
/// linear in the data; the RTS smoother gives its own. What no filter knows is its bias: a movement
/// faster than the cut-off is lost without a trace in the covariance.
/// Accelerations: none from the RTS smoother (its model drives ω and v by noise), none from
/// Butterworth within 1 / (2 cut-off) of a stretch's ends, where the point reflection decides.
/// Stretches too short for a filter are left empty, and `description` says how many poses.
/// Throws std::invalid_argument: cut-off at or beyond half the frame rate, odd order, ….
FilteredSeries FilterPoses(const PoseSeries& series, const FilterOptions& options);

}  // namespace stereomotion
