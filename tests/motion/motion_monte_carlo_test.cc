#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "stereomotion/geometry/so3.h"
#include "stereomotion/motion/one_axis.h"
#include "stereomotion/motion/screw_axis.h"
#include "tests/support/motion_bound.h"
#include "tests/support/motion_cases.h"
#include "tests/support/motion_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

constexpr int kRepetitions = 2000;

/// Rows of all tables in this program that are checked for consistency.
constexpr int kTests = 8 * 4 + 3 * 5;

/// The screw that truly leads from one pose to another: direction, a point of the axis, angle,
/// pitch.
struct TrueScrew {
  Eigen::Vector3d direction, point_mm;
  double angle_rad, pitch_mm_per_rad;
};

TrueScrew ScrewOf(const Rigid3& from, const Rigid3& to) {
  const Rigid3 moved = to * from.Inverse();
  const Eigen::Vector3d turn_rad = LogSO3(moved.rotation);
  TrueScrew screw;
  screw.angle_rad = turn_rad.norm();
  screw.direction = turn_rad / screw.angle_rad;
  const double along_mm = screw.direction.dot(moved.translation_mm);
  screw.pitch_mm_per_rad = along_mm / screw.angle_rad;
  // (I − R) q = t − d (d·t); across the axis I − R is a turn times 2 sin(θ/2).
  const Eigen::Vector3d across_mm = moved.translation_mm - along_mm * screw.direction;
  screw.point_mm =
      (across_mm + screw.direction.cross(across_mm) / std::tan(screw.angle_rad / 2)) / 2;
  return screw;
}

void AddScrew(const ScrewAxis& screw, const TrueScrew& truth, CoverageTable& table) {
  AddAcross("direction", truth.direction, screw.direction - truth.direction,
            screw.covariance.topLeftCorner<3, 3>(), table);
  AddAcross("point", truth.direction, screw.point_mm - truth.point_mm,
            screw.covariance.block<3, 3>(3, 3), table);
  AddNumber("angle", screw.angle_rad - truth.angle_rad, std::sqrt(screw.covariance(6, 6)), table);
  AddNumber("pitch", screw.pitch_mm_per_rad - truth.pitch_mm_per_rad,
            std::sqrt(screw.covariance(7, 7)), table);
}

class ScrewMonteCarlo : public ::testing::TestWithParam<MotionCase> {};

TEST_P(ScrewMonteCarlo, Intervals) {
  std::mt19937_64 rng = MakeTestRng();
  const MotionScene scene = MakeMotionScene(GetParam().plan(), rng);
  const std::size_t first = 3, second = 15;
  const TrueScrew truth =
      ScrewOf(scene.truth[first].world_from_body, scene.truth[second].world_from_body);
  CoverageTable table;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    const PoseSeries series = PosesOf(Observed(scene, rng));
    const auto screw = ScrewBetween(series, first, second, scene.centroid_in_body_mm);
    if (screw) AddScrew(*screw, truth, table);
  }
  fmt::print("{}", table.Text(std::string("screw of ") + GetParam().name));
  EXPECT_TRUE(table.Holds(kRepetitions, FamilyZ(kTests)));
}

INSTANTIATE_TEST_SUITE_P(Motions, ScrewMonteCarlo, ::testing::ValuesIn(AllMotions()), NameOf);

/// A wheel: its axis moves across itself, so that no line is the axis of the whole run.
MotionPlan RollingMotion() {
  MotionPlan plan = SingleAxisMotion();
  plan.frames = 25;  // odd: the run's middle is a frame
  plan.velocity_mm_s = 300 * Across(plan.first_axis).col(0);
  return plan;
}

/// The truth at mid-recording.
MotionTruth MiddleOf(MotionPlan plan) {
  const double duration_s = (plan.frames - 1) / plan.rate_hz;
  plan.frames = 3;
  plan.rate_hz = 2 / duration_s;
  return TrueMotion(plan)[1];
}

class MeanAxisMonteCarlo : public ::testing::TestWithParam<MotionCase> {};

/// Compares with the instantaneous screw axis at mid-run: of a pure screw that is the run's.
void AddMeanAxis(const MeanAxis& mean, const MotionScene& scene, CoverageTable& table) {
  const MotionTruth middle = MiddleOf(scene.plan);
  const Eigen::Vector3d omega = middle.omega_rad_s;
  const Eigen::Vector3d in_world = omega.normalized();
  const Eigen::Vector3d in_body = *TrueAxisInBody(scene.plan);
  AddAcross("direction in world", in_world, mean.axis.in_world - in_world,
            mean.axis.covariance_in_world, table);
  AddAcross("direction in body", in_body, mean.axis.in_body - in_body, mean.axis.covariance_in_body,
            table);
  AddAcross("line's direction", in_world, mean.line_direction - in_world,
            mean.line_direction_covariance, table);
  const Eigen::Vector3d point_mm =
      middle.center_mm + omega.cross(middle.velocity_mm_s) / omega.squaredNorm();
  AddAcross("point", in_world, mean.point_in_world_mm - point_mm, mean.point_covariance_mm2, table);
  AddNumber("pitch", mean.pitch_mm_per_rad - omega.dot(middle.velocity_mm_s) / omega.squaredNorm(),
            mean.u_pitch, table);
}

TEST_P(MeanAxisMonteCarlo, WholeRun) {
  std::mt19937_64 rng = MakeTestRng();
  const MotionScene scene = MakeMotionScene(GetParam().plan(), rng);
  CoverageTable table;
  int refused = 0, pure = 0;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    const auto mean = FindMeanAxis(PosesOf(Observed(scene, rng)), scene.centroid_in_body_mm);
    ASSERT_TRUE(mean);
    refused += mean->axis.accepted ? 0 : 1;
    pure += mean->pure_screw ? 1 : 0;
    AddMeanAxis(*mean, scene, table);
  }
  fmt::print("{}refused {}, pure screw {}\n",
             table.Text(std::string("mean axis of ") + GetParam().name), refused, pure);
  EXPECT_LE(refused, 9);  // level 1e-3: 2 ± 1.4 of 2 000
  EXPECT_TRUE(table.Holds(kRepetitions, FamilyZ(kTests)));
}

INSTANTIATE_TEST_SUITE_P(Motions, MeanAxisMonteCarlo,
                         ::testing::Values(MotionCase{"Screw", ScrewMotion},
                                           MotionCase{"SingleAxis", SingleAxisMotion},
                                           MotionCase{"Rolling", RollingMotion}),
                         NameOf);

}  // namespace
}  // namespace stereomotion::testing
