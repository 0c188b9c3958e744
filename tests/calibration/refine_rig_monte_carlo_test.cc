// A bumped rig refined many times: the stated covariance is the real spread.
#include <gtest/gtest.h>

#include "stereomotion/calibration/refine_rig.h"
#include "tests/support/bumped_scene.h"
#include "tests/support/calibration_scene.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::BumpedScene;
using testing::ErrorStatistics;

constexpr int kRepetitions = 200;
constexpr int kTests = 6;  // NEES figures of this file

struct Spread {
  ErrorStatistics parameters, change;
  int significant = 0, still_fits = 0;
  double turn_sigma_deg = 0, shift_sigma_mm = 0;
};

struct Trial {
  Rig truth;
  Body body;
  double least_turn_deg = 0, most_turn_deg = 0, shift_mm = 0;
  double body_sigma_mm = 0;
};

// The body as it really is, its file being exact only to its sigma_mm.
Body TrueBody(const Body& file, std::mt19937_64& rng) {
  Body body = file;
  for (Rod& rod : body.rods) {
    for (auto& ball : rod.balls_in_body_mm) ball += rod.sigma_mm * testing::NormalVector<3>(rng);
  }
  return body;
}

Spread Repeat(const Trial& trial) {
  Spread spread;
  auto rng = testing::MakeTestRng();
  BumpedScene scene = testing::MakeBumpedScene(trial.truth, trial.body, 16);
  for (int i = 0; i < kRepetitions; ++i) {
    Rig old_rig = trial.truth.covariance ? testing::DrawRig(trial.truth, rng) : trial.truth;
    const double turn_deg = testing::Uniform(rng, trial.least_turn_deg, trial.most_turn_deg);
    testing::Bump(turn_deg, trial.shift_mm, rng, old_rig);
    scene.body = TrueBody(trial.body, rng);
    const auto refined = RefineRig(old_rig, trial.body, testing::See(scene, rng));
    if (!refined) {
      ADD_FAILURE() << refined.error().text;
      continue;
    }
    spread.parameters.Add(testing::RigError(refined->rig, trial.truth),
                          refined->rig.covariance->matrix);
    spread.change.Add(refined->motion.change, refined->motion.covariance);
    spread.significant += refined->motion.significant ? 1 : 0;
    for (const auto& note : refined->warnings) {
      spread.still_fits += note.name == "still_fits" ? 1 : 0;
    }
  }
  return spread;
}

void ExpectTrue(const Spread& spread) {
  EXPECT_TRUE(testing::IsConsistent(spread.parameters, testing::FamilyZ(kTests)))
      << "NEES/dof " << spread.parameters.nees_per_dof() << ", z " << spread.parameters.nees_z()
      << ", worst " << spread.parameters.worst_z();
  ::testing::Test::RecordProperty("nees_per_dof", std::to_string(spread.parameters.nees_per_dof()));
}

TEST(RefineRigMonteCarlo, BumpedRigComesBackWithTrueCovariance) {
  Trial trial{testing::MakeCalibratedRig(), testing::MakeTwoRodBody(), 0.5, 3, 20};
  const Spread spread = Repeat(trial);
  ExpectTrue(spread);
  EXPECT_EQ(spread.significant, kRepetitions);
}

// Nothing moved: what changed is the old calibration's error and the rods', of which the stated
// covariance is the spread. Of 200 judgements at 99.9 %, three would come by chance in 1 of 900.
TEST(RefineRigMonteCarlo, RigThatWasNotBumpedStillFits) {
  Trial trial{testing::MakeCalibratedRig(), testing::MakeTwoRodBody()};
  const Spread spread = Repeat(trial);
  ExpectTrue(spread);
  EXPECT_TRUE(testing::IsConsistent(spread.change, testing::FamilyZ(kTests)))
      << "NEES/dof " << spread.change.nees_per_dof() << ", worst " << spread.change.worst_z();
  EXPECT_LE(spread.significant, 2);
  EXPECT_EQ(spread.still_fits, kRepetitions - spread.significant);
}

TEST(RefineRigMonteCarlo, UncertainBodyWidensTheScale) {
  Trial trial{testing::MakeCalibratedRig(), testing::MakeTwoRodBody(), 0.5, 3, 20};
  for (Rod& rod : trial.body.rods) rod.sigma_mm = 0.05;
  ExpectTrue(Repeat(trial));
}

TEST(RefineRigMonteCarlo, BodyOfOneRod) {
  Trial trial{testing::MakeCalibratedRig(), testing::MakeRodBody({0, 58, 154, 288, 362}), 0.5, 3,
              20};
  ExpectTrue(Repeat(trial));
}

TEST(RefineRigMonteCarlo, RigWithoutCovariance) {
  Trial trial{testing::MakeConvergingRig(), testing::MakeTwoRodBody(), 0.5, 3, 20};
  ExpectTrue(Repeat(trial));
}

}  // namespace
}  // namespace stereomotion
