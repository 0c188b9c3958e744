#include "motion/center_model.h"

#include <gtest/gtest.h>

#include <memory>

#include "motion/reduce_frames.h"
#include "stereomotion/geometry/so3.h"
#include "tests/support/motion_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

/// A model at a random state near the truth, with every kind of unknown.
struct Case {
  std::vector<ObservedFrame> frames;
  CenterModel model;
  CenterUnknowns unknowns;
};

std::unique_ptr<Case> MakeCase(const MotionData& data, int path_terms, bool unknown_balls,
                               std::mt19937_64& rng) {
  auto made = std::make_unique<Case>();
  made->frames = ObservedFrames(data);
  made->model.frames = &made->frames;
  made->model.path_terms = path_terms;
  made->model.origin_in_body_mm = {5, 6, 7};
  made->model.balls_in_body_mm = data.balls_in_body_mm;
  made->model.mid_s = 0.1;
  made->model.half_span_s = 0.2;
  if (unknown_balls) made->model.gauge = StructureGauge(data.balls_in_body_mm);
  made->unknowns = ZeroUnknowns(made->model);
  for (double& value : made->unknowns.globals) value = 3 * testing::Normal(rng);
  for (double& value : made->unknowns.locals.reshaped()) value = 0.01 * testing::Normal(rng);
  return made;
}

Eigen::VectorXd Residual(const Case& c, std::size_t i, const Eigen::VectorXd& local,
                         const Eigen::VectorXd& globals) {
  return Linearize(c.model, c.frames[i], local, globals)->residual;
}

/// The local step after a further left perturbation of the rotation.
Eigen::VectorXd Turned(const Eigen::VectorXd& local, int axis, double step) {
  Eigen::VectorXd turned = local;
  if (axis < 3) {
    turned.head<3>() = LogSO3(ExpSO3(step * Eigen::Vector3d::Unit(axis)) * ExpSO3(local.head<3>()));
  } else {
    turned[axis] += step;
  }
  return turned;
}

void CheckJacobians(const Case& c) {
  constexpr std::size_t kFrame = 3;
  const Eigen::VectorXd local = c.unknowns.locals.col(kFrame), globals = c.unknowns.globals;
  const auto analytic = Linearize(c.model, c.frames[kFrame], local, globals);
  ASSERT_TRUE(analytic);
  for (Eigen::Index k = 0; k < local.size(); ++k) {
    const double step = k < 3 ? 1e-6 : 1e-3;
    const int axis = static_cast<int>(k);
    const Eigen::VectorXd difference = (Residual(c, kFrame, Turned(local, axis, step), globals) -
                                        Residual(c, kFrame, Turned(local, axis, -step), globals)) /
                                       (2 * step);
    EXPECT_LT((difference - analytic->d_local.col(k)).norm(), 1e-5 * difference.norm()) << k;
  }
  for (Eigen::Index k = 0; k < globals.size(); ++k) {
    constexpr double kStep_mm = 1e-3;
    Eigen::VectorXd more = globals, less = globals;
    more[k] += kStep_mm;
    less[k] -= kStep_mm;
    const Eigen::VectorXd difference =
        (Residual(c, kFrame, local, more) - Residual(c, kFrame, local, less)) / (2 * kStep_mm);
    EXPECT_LT((difference - analytic->d_global.col(k)).norm(), 1e-5 * difference.norm()) << k;
  }
}

TEST(CenterModel, JacobiansAreThoseOfDifferences) {
  auto rng = testing::MakeTestRng();
  const auto scene = testing::MakeMotionScene(testing::UniformMotion(), rng);
  for (const int path_terms : {0, 1, 2, 3}) {
    for (const bool unknown : {false, true}) {
      SCOPED_TRACE(path_terms);
      CheckJacobians(*MakeCase(scene.exact, path_terms, unknown, rng));
    }
  }
}

TEST(CenterModel, JacobiansOfPosesAreThoseOfDifferences) {
  auto rng = testing::MakeTestRng();
  const auto scene = testing::MakeMotionScene(testing::UniformMotion(), rng);
  CheckJacobians(*MakeCase(testing::PosesOnly(scene.exact), 2, false, rng));
}

/// Half the squared residual's second differences, which hold Gauss–Newton's part and curvature.
TEST(CenterModel, CurvatureIsThatOfSecondDifferences) {
  auto rng = testing::MakeTestRng();
  testing::SceneOptions options;
  options.with_space_points = true;  // linear in the points: the curvature is exact
  const auto scene = testing::MakeMotionScene(testing::UniformMotion(), rng, options);
  const auto c = MakeCase(scene.exact, 2, true, rng);
  constexpr std::size_t kFrame = 3;
  c->unknowns.locals.col(kFrame).setZero();  // second derivatives by the rotation vector at zero
  const Eigen::VectorXd local = c->unknowns.locals.col(kFrame), globals = c->unknowns.globals;
  const auto equations = Linearize(c->model, c->frames[kFrame], local, globals);
  const FrameCurvature curvature = CurvatureOf(c->model, c->frames[kFrame], local, globals);
  const Eigen::MatrixXd h_local =
      equations->d_local.transpose() * equations->d_local + curvature.local;
  const Eigen::MatrixXd h_mixed =
      equations->d_local.transpose() * equations->d_global + curvature.mixed;
  constexpr double kTurn_rad = 1e-4, kShift_mm = 1e-2;
  const auto cost = [&](const Eigen::VectorXd& l, const Eigen::VectorXd& g) {
    return 0.5 * Residual(*c, kFrame, l, g).squaredNorm();
  };
  const auto mixed_difference = [&](auto move_a, auto move_b, double ab) {
    double sum = 0;
    for (const int sa : {-1, 1}) {
      for (const int sb : {-1, 1}) {
        Eigen::VectorXd l = local, g = globals;
        move_a(l, g, sa);
        move_b(l, g, sb);
        sum += sa * sb * cost(l, g);
      }
    }
    return sum / (4 * ab);
  };
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto turn_i = [&](auto& l, auto&, int s) { l[i] += s * kTurn_rad; };
    for (Eigen::Index j = 0; j < 3; ++j) {
      const auto turn_j = [&](auto& l, auto&, int s) { l[j] += s * kTurn_rad; };
      EXPECT_NEAR(mixed_difference(turn_i, turn_j, kTurn_rad * kTurn_rad), h_local(i, j),
                  1e-5 * h_local.norm());
    }
    for (Eigen::Index k = 0; k < globals.size(); ++k) {
      const auto shift = [&](auto&, auto& g, int s) { g[k] += s * kShift_mm; };
      EXPECT_NEAR(mixed_difference(turn_i, shift, kTurn_rad * kShift_mm), h_mixed(i, k),
                  1e-5 * h_mixed.norm());
    }
  }
}

TEST(CenterModel, GaugeHoldsMeanAndTurn) {
  auto rng = testing::MakeTestRng();
  std::vector<Eigen::Vector3d> balls;
  for (int i = 0; i < 6; ++i) balls.push_back(50 * testing::NormalVector<3>(rng));
  const Eigen::MatrixXd gauge = StructureGauge(balls);
  ASSERT_EQ(gauge.cols(), 12);
  EXPECT_TRUE((gauge.transpose() * gauge).isIdentity(1e-12));
  Eigen::Vector3d mean_mm = Eigen::Vector3d::Zero();
  for (const auto& ball : balls) mean_mm += ball / 6;
  for (Eigen::Index k = 0; k < gauge.cols(); ++k) {
    Eigen::Vector3d shift = Eigen::Vector3d::Zero(), turn = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const Eigen::Vector3d step = gauge.col(k).segment<3>(3 * static_cast<Eigen::Index>(i));
      shift += step;
      turn += (balls[i] - mean_mm).cross(step);
    }
    EXPECT_LT(shift.norm(), 1e-12);
    EXPECT_LT(turn.norm(), 1e-10);
  }
}

/// The eliminated rows give the least of the residuals over the local unknowns.
TEST(ReduceFrames, LeavesWhatTheLocalUnknownsCannotTakeAway) {
  auto rng = testing::MakeTestRng();
  CenterEquations equations;
  equations.residual = testing::NormalVector<9>(rng);
  equations.d_local = Eigen::MatrixXd::NullaryExpr(9, 3, [&] { return testing::Normal(rng); });
  equations.d_global = Eigen::MatrixXd::NullaryExpr(9, 4, [&] { return testing::Normal(rng); });
  const Eigen::Vector4d step = testing::NormalVector<4>(rng);
  const Eigen::VectorXd moved = equations.residual + equations.d_global * step;
  const Eigen::MatrixXd normal = equations.d_local.transpose() * equations.d_local;
  const Eigen::VectorXd least =
      moved - equations.d_local * normal.ldlt().solve(equations.d_local.transpose() * moved);
  Eigen::VectorXd homogeneous(5);
  homogeneous << step, 1;
  EXPECT_NEAR((EliminateLocal(equations) * homogeneous).norm(), least.norm(), 1e-12);
  RowStack stack(5);
  for (int i = 0; i < 10; ++i) stack.Add(EliminateLocal(equations));
  EXPECT_NEAR((stack.Triangle() * homogeneous).squaredNorm(), 10 * least.squaredNorm(), 1e-10);
}

}  // namespace
}  // namespace stereomotion
