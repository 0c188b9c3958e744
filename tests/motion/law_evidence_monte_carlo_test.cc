#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "stereomotion/motion/spin_center.h"
#include "tests/support/coverage_table.h"
#include "tests/support/motion_bound.h"
#include "tests/support/motion_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

constexpr int kRepetitions = 1400;
constexpr int kTests = 2 * 3;
/// 95 % intervals cover at least so much though nobody knows the law.
constexpr double kLeastCoverage = 0.93;
/// Drifts × (three coordinates in the body, three in the world, the longest axis).
constexpr int kAverageTests = 6 * 7;

/// A centre that drifts so slowly that the data hardly tells: `separation` is the velocity in units
/// of its own σ (the root of χ²'s noncentrality) when the law is uniform.
MotionScene DriftingScene(double separation, std::mt19937_64& rng) {
  MotionPlan plan = FixedMotion();
  plan.frames = 16;
  const std::size_t middle = 8;
  const MotionBound bound = BoundOf(MakeMotionScene(plan, rng), PathLaw::kUniform);
  const Eigen::Matrix3d covariance = bound.states[middle].block<3, 3>(3, 3);
  const Eigen::Vector3d way = Eigen::Vector3d::Ones();
  plan.velocity_mm_s = separation / std::sqrt(way.dot(covariance.inverse() * way)) * way;
  plan.law = PathLaw::kUniform;
  return MakeMotionScene(plan, rng);
}

class OpenEvidence : public ::testing::TestWithParam<double> {};

/// Whatever is chosen, the interval under the true law stands in `laws` and covers. What the
/// narrower law leaves out while it is preferred is printed: the interval under the chosen law.
TEST_P(OpenEvidence, WiderLawCovers) {
  std::mt19937_64 rng = MakeTestRng();
  const MotionScene scene = DriftingScene(GetParam(), rng);
  CoverageTable wider, chosen;
  int fixed = 0, open = 0;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    const SpinCenterResult result = FindSpinCenter(Observed(scene, rng));
    fixed += result.law == PathLaw::kFixed ? 1 : 0;
    open += result.evidence_open ? 1 : 0;
    const auto& uniform = result.laws.at(static_cast<std::size_t>(PathLaw::kUniform)).center;
    ASSERT_TRUE(uniform);
    wider.Add("centre, uniform", uniform->in_body_mm - scene.plan.center_in_body_mm,
              uniform->covariance_mm2);
    if (!result.center) continue;
    chosen.Add("centre, chosen law", result.center->in_body_mm - scene.plan.center_in_body_mm,
               result.center->covariance_mm2);
  }
  fmt::print("drift of {} sigma: fixed chosen {:.1f} %, evidence open {:.1f} %\n{}{}", GetParam(),
             100.0 * fixed / kRepetitions, 100.0 * open / kRepetitions, wider.Text(""),
             chosen.Text(""));
  EXPECT_TRUE(wider.Holds(kRepetitions, FamilyZ(kTests)));
}

INSTANTIATE_TEST_SUITE_P(Drifts, OpenEvidence, ::testing::Values(2, 3, 4),
                         [](const auto& one) { return fmt::format("Sigma{}", one.param); });

/// Counts how often 1.96 σ hold the error, by component.
class Coverage {
 public:
  void Add(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
    constexpr double kZ95 = 1.96;
    const Eigen::ArrayXd u = covariance.diagonal().array().sqrt();
    if (covered_.size() == 0) covered_.setZero(error.size());
    covered_ += (error.array().abs() <= kZ95 * u).cast<double>();
    ++count_;
  }
  [[nodiscard]] double Least() const { return covered_.minCoeff() / count_; }
  [[nodiscard]] double Most() const { return covered_.maxCoeff() / count_; }

 private:
  Eigen::ArrayXd covered_;
  int count_ = 0;
};

/// The direction in which the wider law tells the centre worst: there a drift does most harm.
Eigen::Vector3d LongestAxis(const MotionScene& scene) {
  SpinCenterOptions options;
  options.law = PathLaw::kUniform;
  const auto center = FindSpinCenter(scene.exact, options).center;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(center.value().covariance_mm2)
      .eigenvectors()
      .col(2);
}

class UnknownLaw : public ::testing::TestWithParam<double> {};

/// The interval of the average over the laws covers whatever the drift, also while a narrow law is
/// chosen that is not quite true.
TEST_P(UnknownLaw, AverageCovers) {
  std::mt19937_64 rng = MakeTestRng();
  const MotionScene scene = DriftingScene(GetParam(), rng);
  const Eigen::Vector3d axis = LongestAxis(scene);
  const std::size_t middle = scene.plan.frames / 2;
  Coverage in_body, along, in_world, chosen;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    const SpinCenterResult result = FindSpinCenter(Observed(scene, rng));
    // Where a likely law leaves the centre open, no interval is stated and none can fail.
    if (!result.center || !result.covariance_law_unknown_mm2) continue;
    const Eigen::Matrix3d& covariance_mm2 = *result.covariance_law_unknown_mm2;
    const Eigen::Vector3d error_mm = result.center->in_body_mm - scene.plan.center_in_body_mm;
    in_body.Add(error_mm, covariance_mm2);
    chosen.Add(error_mm, result.center->covariance_mm2);
    along.Add(axis.transpose() * error_mm, axis.transpose() * covariance_mm2 * axis);
    in_world.Add(result.center->states[middle].position_mm - scene.truth[middle].center_mm,
                 PositionCovarianceLawUnknown(result, middle).value());
  }
  fmt::print(
      "drift {} sigma: body {:.3f}-{:.3f}, longest axis {:.3f}, world {:.3f}-{:.3f}; "
      "chosen law's own {:.3f}-{:.3f}\n",
      GetParam(), in_body.Least(), in_body.Most(), along.Least(), in_world.Least(), in_world.Most(),
      chosen.Least(), chosen.Most());
  const double spread = std::sqrt(kLeastCoverage * (1 - kLeastCoverage) / kRepetitions);
  const double bound = kLeastCoverage - FamilyZ(kAverageTests) * spread;
  EXPECT_GE(in_body.Least(), bound);
  EXPECT_GE(along.Least(), bound);
  EXPECT_GE(in_world.Least(), bound);
}

INSTANTIATE_TEST_SUITE_P(Drifts, UnknownLaw, ::testing::Values(0, 1, 2, 3, 4, 5),
                         [](const auto& one) { return fmt::format("Sigma{}", one.param); });

}  // namespace
}  // namespace stereomotion::testing
