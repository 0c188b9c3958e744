#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "../support/rod_scene.h"
#include "../support/statistics.h"
#include "../support/test_rng.h"
#include "stereomotion/detection/detect_balls.h"

namespace stereomotion {
namespace {

using testing::ErrorStatistics;
using testing::MakeTestRng;
using testing::RodScene;
using testing::SceneBar;
using testing::SceneRod;
using testing::Uniform;

constexpr double kPi = 3.14159265358979323846;
constexpr SensorNoise kNoise{58.8, 8, 0, 255};
/// Ball 0 is the one tested; ball 1 stands free: it shows how balls look.
constexpr int kTests = 8;
#ifndef SECOND_LOOK_REPEATS
#define SECOND_LOOK_REPEATS 1  // the slow program sets it
#endif
constexpr int kRepeats = SECOND_LOOK_REPEATS;

RodScene TwoBalls(std::mt19937_64& rng) {
  RodScene scene;
  scene.balls.push_back({{24 + Uniform(rng, -0.5, 0.5), 24 + Uniform(rng, -0.5, 0.5)}});
  scene.balls.push_back({{70 + Uniform(rng, -0.5, 0.5), 24 + Uniform(rng, -0.5, 0.5)}});
  return scene;
}

/// Finds the measured ball within three pixels of `center_px`.
std::optional<BallObservation> MeasuredAt(const std::vector<BallObservation>& balls,
                                          const Eigen::Vector2d& center_px) {
  for (const BallObservation& ball : balls) {
    const bool near = (ball.center_px - center_px).norm() < 3;
    if (near && ball.status == BlobStatus::kOk) return ball;
  }
  return std::nullopt;
}

/// Counts what became of ball 0 in images of random scenes.
struct Outcome {
  int images = 0, measured = 0;
  ErrorStatistics errors;
  Eigen::Vector2d error_sum_px = Eigen::Vector2d::Zero();

  void Add(const RodScene& scene, std::mt19937_64& rng, std::size_t ball = 0) {
    const Image image = RenderRodScene(scene, kNoise, rng);
    const auto found = MeasuredAt(DetectBalls(image.View(), kNoise), scene.balls[ball].center_px);
    ++images;
    if (!found) return;
    ++measured;
    const Eigen::Vector2d error_px = found->center_px - scene.balls[ball].center_px;
    errors.Add(error_px, found->covariance_px2);
    error_sum_px += error_px;
  }
  [[nodiscard]] double share() const { return static_cast<double>(measured) / images; }
};

/// Two-sided, all tests of this program together.
double FamilyZ() { return testing::FamilyZ(kTests); }

/// Smallest share that a detector with this recall shows (normal approximation of the binomial).
double LeastShare(double recall, const Outcome& outcome) {
  return recall - FamilyZ() * std::sqrt(recall * (1 - recall) / outcome.images);
}

Outcome MeasureWithRods(double level_dn, double steepest_rad, int images, std::mt19937_64& rng) {
  Outcome outcome;
  for (int i = 0; i < images; ++i) {
    RodScene scene = TwoBalls(rng);
    SceneRod rod;
    rod.angle_rad = Uniform(rng, 0, 2 * kPi);
    rod.tilt_rad = Uniform(rng, -steepest_rad, steepest_rad);
    rod.half_width_px = Uniform(rng, 0.8, 1.6);
    rod.level_dn = level_dn;
    rod.behind = i % 3 != 0;  // one ball in three is a rod's end
    scene.rods.push_back(rod);
    outcome.Add(scene, rng);
  }
  return outcome;
}

TEST(SecondLook, DarkRodDoesNotPullTheCentre) {
  auto rng = MakeTestRng();
  const Outcome outcome = MeasureWithRods(7, 0.4, 36 * kRepeats, rng);
  EXPECT_GE(outcome.share(), LeastShare(0.98, outcome));
  EXPECT_TRUE(IsConsistent(outcome.errors, FamilyZ()));
}

TEST(SecondLook, BrightRodDoesNotPullTheCentre) {
  auto rng = MakeTestRng();
  const Outcome outcome = MeasureWithRods(60, 0.4, 36 * kRepeats, rng);
  EXPECT_GE(outcome.share(), LeastShare(0.98, outcome));
  EXPECT_TRUE(IsConsistent(outcome.errors, FamilyZ()));
}

TEST(SecondLook, RodCostsLittlePrecision) {
  auto rng = MakeTestRng();
  auto free_rng = MakeTestRng(1);
  const Outcome with_rod = MeasureWithRods(7, 0.3, 20 * kRepeats, rng);
  Outcome free;
  for (int i = 0; i < 10 * kRepeats; ++i) free.Add(TwoBalls(free_rng), free_rng);
  // The share of the limb behind the rod's front, 15 %, and what its unknowns take: bar of issue 4.
  EXPECT_LT(with_rod.errors.stated_rmse() / free.errors.stated_rmse(), 1.3);
}

TEST(SecondLook, BarAcrossTheBall) {
  auto rng = MakeTestRng();
  Outcome outcome;
  for (int i = 0; i < 28 * kRepeats; ++i) {
    RodScene scene = TwoBalls(rng);
    SceneBar bar;
    // Not towards the other ball.
    bar.angle_rad = (i % 2 == 0 ? 0.5 : -0.5) * kPi + Uniform(rng, -0.8, 0.8);
    // Its edge passes the centre at 1 … 4 px: up to 38 % of the ball are hidden.
    const double across = bar.half_width_px + Uniform(rng, 1, 4);
    bar.point_px = scene.balls[0].center_px +
                   across * Eigen::Vector2d(-std::sin(bar.angle_rad), std::cos(bar.angle_rad));
    scene.bars.push_back(bar);
    outcome.Add(scene, rng);
  }
  EXPECT_GE(outcome.share(), LeastShare(0.95, outcome));
  EXPECT_TRUE(IsConsistent(outcome.errors, FamilyZ()));
}

TEST(SecondLook, MostlyHiddenBallIsNotReportedAsGood) {
  auto rng = MakeTestRng();
  Outcome outcome;
  for (int i = 0; i < 20 * kRepeats; ++i) {
    RodScene scene = TwoBalls(rng);
    SceneBar bar;
    bar.angle_rad = (i % 2 == 0 ? 0.5 : -0.5) * kPi + Uniform(rng, -0.8, 0.8);
    bar.half_width_px = 6;
    const double across = bar.half_width_px - Uniform(rng, 1.5, 4);  // 67 … 93 % hidden
    bar.point_px = scene.balls[0].center_px +
                   across * Eigen::Vector2d(-std::sin(bar.angle_rad), std::cos(bar.angle_rad));
    scene.bars.push_back(bar);
    outcome.Add(scene, rng);
  }
  // Whatever is given as measured must be true.
  if (outcome.measured > 0) {
    EXPECT_TRUE(IsConsistent(outcome.errors, FamilyZ()));
  }
}

TEST(SecondLook, TouchingBalls) {
  auto rng = MakeTestRng();
  Outcome outcome;
  for (int i = 0; i < 16 * kRepeats; ++i) {
    RodScene scene = TwoBalls(rng);
    const double angle = Uniform(rng, 0, 2 * kPi);
    const double gap_px = Uniform(rng, -0.5, 1.0);
    scene.balls.push_back({scene.balls[0].center_px +
                           (10.8 + gap_px) * Eigen::Vector2d(std::cos(angle), std::sin(angle))});
    outcome.Add(scene, rng, 0);
    outcome.Add(scene, rng, 2);
  }
  EXPECT_GE(outcome.share(), LeastShare(0.95, outcome));
  EXPECT_TRUE(IsConsistent(outcome.errors, FamilyZ()));
}

TEST(SecondLook, OverlappingBalls) {
  auto rng = MakeTestRng();
  Outcome outcome;
  for (int i = 0; i < 16 * kRepeats; ++i) {
    RodScene scene = TwoBalls(rng);
    const double angle = Uniform(rng, 0, 2 * kPi);
    const double apart_px = Uniform(rng, 7.0, 9.5);  // 82 … 97 % of the farther one visible
    scene.balls.push_back(
        {scene.balls[0].center_px + apart_px * Eigen::Vector2d(std::cos(angle), std::sin(angle))});
    outcome.Add(scene, rng, 0);
    outcome.Add(scene, rng, 2);
  }
  EXPECT_GE(outcome.share(), LeastShare(0.9, outcome));
  EXPECT_TRUE(IsConsistent(outcome.errors, FamilyZ()));
}

TEST(SecondLook, RectangleIsNoBall) {
  auto rng = MakeTestRng();
  for (int i = 0; i < 16 * kRepeats; ++i) {
    RodScene scene = TwoBalls(rng);
    scene.balls[0].center_px = {-50, -50};
    SceneBar plate;
    plate.point_px = {24, 24};
    plate.angle_rad = Uniform(rng, 0, kPi / 2);
    plate.half_width_px = Uniform(rng, 3, 6);
    plate.level_dn = 165;
    plate.end_px = 5;
    SceneBar end = plate;  // its other end: background before the bright strip
    end.level_dn = scene.background_dn;
    end.half_width_px = 30;
    end.end_px = -5;
    scene.bars = {end, plate};
    const Image image = RenderRodScene(scene, kNoise, rng);
    EXPECT_FALSE(MeasuredAt(DetectBalls(image.View(), kNoise), {24, 24}).has_value());
  }
}

}  // namespace
}  // namespace stereomotion
