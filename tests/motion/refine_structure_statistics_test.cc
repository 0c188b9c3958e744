#include <gtest/gtest.h>

#include "stereomotion/motion/refine_structure.h"
#include "structure_case.h"

namespace stereomotion::testing {
namespace {

TEST(RefineStructure, CovarianceIsTheSpread) {
  auto rng = MakeTestRng();
  const MotionScene scene = MakeMotionScene(PrecessionMotion(), rng);
  const auto start_mm = Shaken(scene.exact.balls_in_body_mm, 0.3, rng);
  constexpr int kRepetitions = 200;
  ErrorStatistics errors, residuals;
  for (int i = 0; i < kRepetitions; ++i) {
    const auto structure = RefineStructure(UnknownBody(scene, start_mm, rng));
    ASSERT_TRUE(structure);
    AddInGauge(ErrorOf(*structure, scene, start_mm), structure->covariance_mm2, errors);
    // χ² is a sum of `dof` squares: mean dof, variance 2 dof.
    residuals.Add(Eigen::VectorXd::Constant(1, structure->chi2 - structure->dof),
                  Eigen::MatrixXd::Constant(1, 1, 2.0 * structure->dof));
  }
  EXPECT_TRUE(IsConsistent(errors, FamilyZ(2)));
  EXPECT_TRUE(IsConsistent(residuals, FamilyZ(2)));
}

TEST(RefineStructure, GrossErrorsAreLeftOut) {
  auto rng = MakeTestRng();
  const MotionScene scene = MakeMotionScene(PrecessionMotion(), rng);
  const auto start_mm = Shaken(scene.exact.balls_in_body_mm, 0.3, rng);
  constexpr int kRepetitions = 20;
  ErrorStatistics errors;
  for (int i = 0; i < kRepetitions; ++i) {
    MotionData data = UnknownBody(scene, start_mm, rng);
    for (std::size_t frame = 0; frame < data.frames.size(); frame += 3) {
      data.frames[frame].image_points[frame % 7].center_px += 2 * NormalVector<2>(rng);
    }
    const auto structure = RefineStructure(data);
    ASSERT_TRUE(structure);
    EXPECT_GE(structure->rejected, 7);
    EXPECT_LE(structure->rejected, 10);
    AddInGauge(ErrorOf(*structure, scene, start_mm), structure->covariance_mm2, errors);
  }
  EXPECT_TRUE(IsConsistent(errors, FamilyZ(1)));
}

TEST(RefineStructure, SpacePoints) {
  auto rng = MakeTestRng();
  SceneOptions options;
  options.with_space_points = true;
  const MotionScene scene = MakeMotionScene(PrecessionMotion(), rng, options);
  const auto start_mm = Shaken(scene.exact.balls_in_body_mm, 0.3, rng);
  ErrorStatistics errors;
  constexpr int kRepetitions = 40;
  for (int i = 0; i < kRepetitions; ++i) {
    const auto structure = RefineStructure(UnknownBody(scene, start_mm, rng));
    ASSERT_TRUE(structure);
    AddInGauge(ErrorOf(*structure, scene, start_mm), structure->covariance_mm2, errors);
  }
  EXPECT_TRUE(IsConsistent(errors, FamilyZ(1)));
}

}  // namespace
}  // namespace stereomotion::testing
