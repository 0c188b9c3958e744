#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "motion/center_model.h"
#include "motion/condense_frames.h"
#include "stereomotion/core/expected.h"
#include "stereomotion/motion/one_axis.h"

namespace stereomotion {

/// Holds the data of a spin centre's estimation, the same for all laws.
struct CenterProblem {
  const MotionData* data = nullptr;
  std::vector<ObservedFrame> frames;  ///< as observed; start: the frame's own pose
  std::vector<ObservedFrame> poses;   ///< the same frames condensed to their own pose
  bool has_points = false;
  Eigen::MatrixXd gauge;      ///< of an unknown structure; else no columns
  Eigen::VectorXd structure;  ///< its start, by the free fit
  Eigen::Vector3d origin_in_body_mm = Eigen::Vector3d::Zero();  ///< the balls' centroid
  Eigen::Matrix3Xd basis;  ///< directions in which the centre can be sought
  std::optional<Eigen::Vector3d> free_axis_in_body;
  std::optional<Eigen::Vector3d> main_axis_in_body;  ///< that the body turns about on the whole
  bool one_rod = false;  ///< the roll about it is open: the centre is sought on it
  bool turns = false;    ///< the rotation rises above its noise
  int rows = 0;          ///< scalar observations
  double chi2_free = 0;  ///< of the frames' own poses
  int dof_free = 0;
  double mid_s = 0, half_span_s = 1;
};

/// Prepares the data: every frame's own pose (and an unknown structure with them), and whether the
/// body turned about no axis, one or several.
CenterProblem PrepareCenter(const MotionData& data);

/// Leaves frames out, given by their places in `CenterProblem::frames`, and prepares what
/// depends on them again.
void LeaveOut(CenterProblem& problem, const std::vector<std::size_t>& places);

/// Gives the direction of one rod's line, unit, in the body frame.
Eigen::Vector3d RodInBody(const CenterProblem& problem);

/// Makes the model of one law (coefficients of the path) on the frames as observed or condensed.
CenterModel ModelOf(const CenterProblem& problem, int path_terms, bool condensed);

}  // namespace stereomotion
