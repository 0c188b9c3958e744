#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "motion/point_residual.h"
#include "stereomotion/geometry/rigid3.h"
#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Holds one frame of a structure problem.
struct StructureFrame {
  std::size_t index = 0;  ///< of the data's frames
  Rigid3 world_from_body;
  std::vector<PointObservation> observations;
};

/// Holds geometry and poses at one state, with the observations that count.
struct StructureProblem {
  std::vector<Eigen::Vector3d> balls_in_body_mm;
  /// Direction of the line that all balls lie on, then taken for straight: balls shift along it
  /// only, and the roll about it is open. Nothing: any other body.
  std::optional<Eigen::Vector3d> rod_in_body;
  std::vector<StructureFrame> frames;

  /// Counts the observations of every ball.
  [[nodiscard]] std::vector<int> CountObservations() const;
};

/// Finds the mean; zero of no points.
Eigen::Vector3d MeanOf(const std::vector<Eigen::Vector3d>& points_mm);

/// Holds an observation's whitened residual with its derivatives at a state.
struct StructureResidual {
  Eigen::Vector3d whitened;
  Eigen::Matrix<double, 3, 6> d_pose;  ///< by (δθ, δt) of `Perturb`
  Eigen::Matrix3d d_ball;              ///< by the ball's place in the body
};

/// Compares an observation with its prediction; nothing where the camera cannot see the ball.
std::optional<StructureResidual> CompareStructure(const PointObservation& observation,
                                                  const Rigid3& world_from_body,
                                                  const Eigen::Vector3d& ball_in_body_mm);

/// Spans, in its columns, the changes (δθ, δt) of a frame's pose that show: all six, of a straight
/// rod all but the roll.
Eigen::MatrixXd PoseDirections(const StructureProblem& problem, const StructureFrame& frame);

/// Sets the problem up: the measured frames that can carry a pose, and of them what the cameras can
/// see. The balls are shifted so that their mean is the origin, the poses likewise.
StructureProblem MakeStructureProblem(const MotionData& data);

/// Takes frames out whose observations leave the pose open.
void DropOpenFrames(StructureProblem& problem);

/// Minimises the whitened residuals over poses and geometry (Ceres, Levenberg–Marquardt, poses
/// eliminated); the gauge is left as it falls. `cauchy_sigma` > 0: robust loss of that width.
/// Returns whether it converged.
bool SolveStructure(StructureProblem& problem, double cauchy_sigma);

}  // namespace stereomotion
