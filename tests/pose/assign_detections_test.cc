#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "stereomotion/geometry/so3.h"
#include "stereomotion/pose/acquire_pose.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

class AssignDetectionsTest : public ::testing::Test {
 protected:
  Rig rig_ = MakeConvergingRig();
  Body body_ = MakeTwoRodBody();
  std::mt19937_64 rng_ = MakeTestRng();
  Rigid3 truth_{ExpSO3({0.2, -0.3, 0.1}), {10, -20, 30}};

  std::vector<BallAssignment> Assign(const ObservedPair& pair, double gate_px) const {
    return AssignDetections(rig_.cameras[0], rig_.cameras[1], body_, pair.left, pair.right, truth_,
                            gate_px);
  }
  static bool Has(const std::vector<BallAssignment>& list, const BallAssignment& wanted) {
    return std::any_of(list.begin(), list.end(), [&](const BallAssignment& a) {
      return a.id == wanted.id && a.camera == wanted.camera && a.detection == wanted.detection;
    });
  }
};

TEST_F(AssignDetectionsTest, FindsEveryBallAmongFalseOnes) {
  ObserveOptions observe;
  observe.false_balls = 24;
  const ObservedPair pair = Observe(rig_.cameras[0], rig_.cameras[1], body_, truth_, observe, rng_);
  const auto assignments = Assign(pair, 2);
  EXPECT_EQ(assignments.size(), pair.truth.size());
  for (const BallAssignment& wanted : pair.truth) EXPECT_TRUE(Has(assignments, wanted));
}

TEST_F(AssignDetectionsTest, NothingWithinTheGate) {
  ObservedPair pair = Observe(rig_.cameras[0], rig_.cameras[1], body_, truth_, {}, rng_);
  for (auto* list : {&pair.left, &pair.right}) {
    for (BallObservation& ball : *list) ball.center_px.x() += 5;
  }
  EXPECT_TRUE(Assign(pair, 4).empty());
  EXPECT_EQ(Assign(pair, 6).size(), pair.truth.size());
}

TEST_F(AssignDetectionsTest, OneDetectionServesOneBall) {
  ObservedPair pair = Observe(rig_.cameras[0], rig_.cameras[1], body_, truth_, {}, rng_);
  // A gate as wide as the image: still one to one, and still the nearest in sum.
  const auto assignments = Assign(pair, 2000);
  EXPECT_EQ(assignments.size(), pair.truth.size());
  for (const BallAssignment& wanted : pair.truth) EXPECT_TRUE(Has(assignments, wanted));
}

TEST_F(AssignDetectionsTest, BallOfAnotherSizeIsAnotherBall) {
  ObservedPair pair = Observe(rig_.cameras[0], rig_.cameras[1], body_, truth_, {}, rng_);
  const BallAssignment victim = pair.truth.front();
  ObservationOf(pair, victim).semi_major_px *= 2;
  ObservationOf(pair, victim).semi_minor_px *= 2;
  EXPECT_FALSE(Has(Assign(pair, 4), victim));
  ObservationOf(pair, victim).status = BlobStatus::kPartly;  // may have any size
  EXPECT_TRUE(Has(Assign(pair, 4), victim));
}

TEST_F(AssignDetectionsTest, GateMustBePositive) {
  EXPECT_THROW(Assign({}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion::testing
