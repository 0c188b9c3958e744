#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "stereomotion/camera/rig.h"
#include "stereomotion/motion/motion_data.h"
#include "tests/support/motion_plan.h"

namespace stereomotion::testing {

struct SceneOptions {
  double sigma_px = 0.0033;        ///< mean standard deviation of a centre
  bool with_space_points = false;  ///< instead of image points: isotropic noise of `sigma_mm`
  double sigma_mm = 0.03;
};

/// Holds a motion as two cameras see it, at centres level: what is the same in all repetitions.
struct MotionScene {
  MotionPlan plan;
  std::vector<MotionTruth> truth;  ///< one a frame
  Eigen::Vector3d centroid_in_body_mm;
  MotionData exact;  ///< no noise; poses carry the covariance that the centres give
  /// 6×2n gain of each frame: the maximum-likelihood step from the true pose to that of the noisy
  /// points (linearised: exact to the square of 0.003 px).
  std::vector<Eigen::MatrixXd> pose_from_points;
};

/// Makes a scene of `MakeConvergingRig` and `MakeTwoRodBody`. `rng` draws the centres' covariances,
/// which are neither isotropic nor alike.
MotionScene MakeMotionScene(const MotionPlan& plan, std::mt19937_64& rng,
                            const SceneOptions& options = {});

/// The same for poses that were made otherwise; `plan` is kept for reference.
MotionScene MakeMotionScene(const MotionPlan& plan, std::vector<MotionTruth> truth,
                            std::mt19937_64& rng, const SceneOptions& options = {});

/// Draws the noise of one repetition: points, and the poses estimated from them.
MotionData Observed(const MotionScene& scene, std::mt19937_64& rng);

/// Shows, without noise, what cameras see that are not quite the scene's, of balls that are not
/// quite where the body has them: rig and body of the data stay the scene's, and so do weights.
MotionData SeenOtherwise(const MotionScene& scene, const Rig& true_rig,
                         const std::vector<Eigen::Vector3d>& true_balls_mm);

/// Takes the points away: the poses are then what was observed.
MotionData PosesOnly(MotionData data);

}  // namespace stereomotion::testing
