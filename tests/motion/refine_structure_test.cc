#include "stereomotion/motion/refine_structure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "motion/structure_problem.h"
#include "stereomotion/geometry/so3.h"
#include "structure_case.h"

namespace stereomotion::testing {
namespace {

TEST(RefineStructure, ExactPointsGiveTheExactBody) {
  auto rng = MakeTestRng();
  const MotionScene scene = MakeMotionScene(PrecessionMotion(), rng);
  const auto start_mm = Shaken(scene.exact.balls_in_body_mm, 1, rng);
  MotionData data = scene.exact;
  data.balls_in_body_mm = start_mm;
  const auto structure = RefineStructure(data);
  ASSERT_TRUE(structure);
  // Convergence to far below the noise, which moves a ball by some 0.01 mm.
  EXPECT_LT(ErrorOf(*structure, scene, start_mm).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT(structure->chi2, 1e-6);
  EXPECT_EQ(structure->rejected, 0);
  for (std::size_t i = 0; i < data.frames.size(); ++i) {
    const Eigen::Vector3d ball = structure->poses[i] * structure->balls_in_body_mm[3];
    const Eigen::Vector3d truth = scene.truth[i].world_from_body * scene.exact.balls_in_body_mm[3];
    EXPECT_LT((ball - truth).norm(), 1e-5);
  }
}

TEST(RefineStructure, KeepsItsGauge) {
  auto rng = MakeTestRng();
  const MotionScene scene = MakeMotionScene(PrecessionMotion(), rng);
  const auto start_mm = Shaken(scene.exact.balls_in_body_mm, 0.3, rng);
  const auto structure = RefineStructure(UnknownBody(scene, start_mm, rng));
  ASSERT_TRUE(structure);
  const Eigen::Vector3d mean_mm = Columns(start_mm).rowwise().mean();
  Eigen::Vector3d sum_mm = Eigen::Vector3d::Zero(), turn_mm2 = Eigen::Vector3d::Zero();
  const auto n = static_cast<Eigen::Index>(start_mm.size());
  Eigen::MatrixXd constraints(6, 3 * n);
  for (std::size_t i = 0; i < start_mm.size(); ++i) {
    sum_mm += structure->balls_in_body_mm[i];
    turn_mm2 += (start_mm[i] - mean_mm).cross(structure->balls_in_body_mm[i]);
    constraints.block<3, 3>(0, static_cast<Eigen::Index>(3 * i)).setIdentity();
    constraints.block<3, 3>(3, static_cast<Eigen::Index>(3 * i)) = Hat(start_mm[i] - mean_mm);
  }
  EXPECT_LT(sum_mm.norm(), 1e-9);
  EXPECT_LT(turn_mm2.norm(), 1e-6);
  EXPECT_LT((constraints * structure->covariance_mm2).norm(), 1e-9);
}

TEST(RefineStructure, JacobiansAgreeWithDifferences) {
  auto rng = MakeTestRng();
  const MotionScene scene = MakeMotionScene(PrecessionMotion(), rng);
  const StructureProblem problem = MakeStructureProblem(scene.exact);
  const StructureFrame& frame = problem.frames[3];
  for (const PointObservation& observation : frame.observations) {
    const Eigen::Vector3d ball =
        problem.balls_in_body_mm[static_cast<std::size_t>(observation.ball)];
    const auto at = CompareStructure(observation, frame.world_from_body, ball);
    ASSERT_TRUE(at);
    for (int k = 0; k < 9; ++k) {
      const double h = k < 3 ? 1e-6 : 1e-3;
      const auto shifted = [&](double step) {
        if (k >= 6) {
          return CompareStructure(observation, frame.world_from_body,
                                  ball + step * Eigen::Vector3d::Unit(k - 6))
              ->whitened;
        }
        return CompareStructure(observation,
                                Perturb(frame.world_from_body, step * Vector6d::Unit(k)), ball)
            ->whitened;
      };
      const Eigen::Vector3d numeric = (shifted(h) - shifted(-h)) / (2 * h);
      Eigen::Matrix<double, 3, 9> all;
      all << at->d_pose, at->d_ball;
      const Eigen::Vector3d analytic = all.col(k);
      EXPECT_LT((numeric - analytic).norm(), 1e-5 * analytic.norm() + 1e-6) << k;
    }
  }
}

TEST(RefineStructure, CalibrationAgainstSolvingAgain) {
  auto rng = MakeTestRng();
  const MotionScene scene = MakeMotionScene(PrecessionMotion(), rng);
  MotionData data = scene.exact;
  const auto start_mm = data.balls_in_body_mm;
  // One parameter at a time, its σ as large as the step: δx = ± σ-column of the covariance.
  for (const int index : {0, 3, 10, 12}) {
    const double step = index == 10 ? 1e-5 : 1e-2;
    data.rig.covariance = RigCovariance{{{1, index}}, Eigen::MatrixXd::Constant(1, 1, step * step)};
    const auto stated = RefineStructure(data);
    MotionData off = data;
    RigCamera& camera = off.rig.cameras[1];
    if (index == 0) camera.model.fx_px += step;
    if (index == 3) camera.model.cy_px += step;
    if (index >= 9) {
      camera.cam_from_world = Perturb(camera.cam_from_world, step * Vector6d::Unit(index - 9));
    }
    const auto moved = RefineStructure(off, {1e6});
    ASSERT_TRUE(stated && moved);
    const Eigen::VectorXd shift = ErrorOf(*moved, scene, start_mm);
    const Eigen::MatrixXd expected = shift * shift.transpose();
    EXPECT_LT((stated->calibration_covariance_mm2 - expected).norm(), 0.01 * expected.norm())
        << index;
  }
}

TEST(RefineStructure, TooFewBalls) {
  auto rng = MakeTestRng();
  const MotionScene scene = MakeMotionScene(PrecessionMotion(), rng);
  const auto failure = [&](const MotionData& data) {
    const auto structure = RefineStructure(data);
    return !structure && structure.error() == StructureFailure::kTooFewBalls;
  };
  MotionData unseen = scene.exact;
  unseen.balls_in_body_mm.emplace_back(10, 20, 30);
  EXPECT_TRUE(failure(unseen));
  EXPECT_TRUE(failure(MotionData{}));
}

TEST(RefineStructure, BadOptions) { EXPECT_THROW(RefineStructure({}, {0}), std::invalid_argument); }

}  // namespace
}  // namespace stereomotion::testing
