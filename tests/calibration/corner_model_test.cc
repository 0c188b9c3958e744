#include "src/calibration/corner_model.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "src/calibration/bivariate_normal.h"
#include "src/calibration/ellipse_model.h"
#include "src/calibration/line_bend.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::Uniform;

CornerModel DrawCorner(CornerShape shape, std::mt19937_64& rng) {
  CornerModel model;
  model.shape = shape;
  const double angle = Uniform(rng, -3, 3);
  model.values << Uniform(rng, 9, 11), Uniform(rng, 9, 11), angle, angle + Uniform(rng, 1, 2.1),
      Uniform(rng, 0.5, 2), 20, 180, 0.002, -0.003;
  model.curvature = {Eigen::Vector2d(1e-3, -2e-3), Eigen::Vector2d(-2e-3, 5e-4)};
  model.origin_px = {10, 10};
  return model;
}

/// Compares a model's gradient with central differences at places all around (10, 10).
template <class Model, class Predictor>
void ExpectGradient(const Model& model, double step, double tolerance_dn) {
  for (double v = 4; v <= 16; v += 1.5) {
    for (double u = 4; u <= 16; u += 1.5) {
      typename Model::Vector gradient;
      Predictor(model).Grey({u, v}, &gradient);
      for (int k = 0; k < Model::kNumParameters; ++k) {
        Model above = model, below = model;
        above.values[k] += step;
        below.values[k] -= step;
        const double difference =
            (Predictor(above).Grey({u, v}, nullptr) - Predictor(below).Grey({u, v}, nullptr)) /
            (2 * step);
        EXPECT_NEAR(gradient[k], difference, tolerance_dn * (1 + std::fabs(difference)))
            << k << " at " << u << ' ' << v;
      }
    }
  }
}

TEST(BivariateNormal, QuadrantIsSheppardsFormula) {
  // P(x < 0, y < 0) = 1/4 + asin(ρ) / 2π.
  for (const double rho : {-0.8, -0.4, 0.0, 0.3, 0.8}) {
    EXPECT_NEAR(0.25 + CorrelationShare(0, 0, rho), 0.25 + std::asin(rho) / (2 * M_PI), 1e-5);
  }
}

TEST(CornerModel, GradientIsThatOfTheModel) {
  auto rng = MakeTestRng();
  for (const CornerShape shape : {CornerShape::kWedge, CornerShape::kSaddle}) {
    for (int i = 0; i < 10; ++i) {
      // 0.02: the correlation's integral is cut off where it is below 1e-5 of the contrast.
      ExpectGradient<CornerModel, CornerPredictor>(DrawCorner(shape, rng), 1e-4, 0.02);
    }
  }
}

TEST(CornerModel, WedgesAndSaddlesAddUp) {
  // A saddle is the wedge and the one opposite to it.
  auto rng = MakeTestRng();
  for (int i = 0; i < 10; ++i) {
    CornerModel saddle = DrawCorner(CornerShape::kSaddle, rng);
    saddle.values.tail<2>().setZero();
    saddle.curvature = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
    CornerModel wedge = saddle;
    wedge.shape = CornerShape::kWedge;
    CornerModel opposite = wedge;
    opposite.values[CornerModel::kAngle0] += M_PI;
    opposite.values[CornerModel::kAngle1] += M_PI;
    for (double u = 5; u <= 15; u += 0.7) {
      const Eigen::Vector2d at(u, 20 - u + 0.3);
      const double sum_dn = CornerPredictor(wedge).Grey(at, nullptr) +
                            CornerPredictor(opposite).Grey(at, nullptr) - 180;
      EXPECT_NEAR(CornerPredictor(saddle).Grey(at, nullptr), sum_dn, 0.01);
    }
  }
}

TEST(EllipseModel, GradientIsThatOfTheModel) {
  auto rng = MakeTestRng();
  for (int i = 0; i < 10; ++i) {
    EllipseModel model;
    model.origin_px = {10, 10};
    model.values << Uniform(rng, 9.9, 10.1), Uniform(rng, 9.9, 10.1), Uniform(rng, 0.15, 0.3),
        Uniform(rng, -0.05, 0.05), Uniform(rng, 0.15, 0.3), Uniform(rng, 0.5, 2), 20, 180, 0.002,
        -0.003;
    ExpectGradient<EllipseModel, EllipsePredictor>(model, 1e-6, 1e-3);
  }
}

TEST(EllipseModel, DiameterOfATurnedEllipse) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(0.7).toRotationMatrix();
  const Eigen::Matrix2d metric =
      turn * Eigen::Vector2d(1 / 64.0, 1 / 25.0).asDiagonal() * turn.transpose();
  const Eigen::Matrix2d shape = metric.llt().matrixU();
  EllipseModel model;
  model.values[EllipseModel::kShapeUu] = shape(0, 0);
  model.values[EllipseModel::kShapeUv] = shape(0, 1);
  model.values[EllipseModel::kShapeVv] = shape(1, 1);
  EXPECT_NEAR(model.DiameterPx(), 8 + 5, 1e-9);
}

TEST(LineBend, RadialDistortionBendsLinesByItsSecondDerivative) {
  // u' = u (1 + k r²): along v at (u0, 0) the curvature of the line u = u0 is 2 k u0.
  constexpr double kDistortion = 2e-8;  // 1/px²
  std::vector<Eigen::Vector2d> board_mm, pixels_px;
  for (double y = -250; y <= 250; y += 50) {
    for (double x = -300; x <= 300; x += 50) {
      const Eigen::Vector2d p(x, y);
      board_mm.push_back(p);
      pixels_px.emplace_back(p * (1 + kDistortion * p.squaredNorm()));
    }
  }
  const LineBend bend(board_mm, pixels_px);
  const Eigen::Vector2d curvature = bend.Curvature({200, 0}, {0, 1});
  EXPECT_NEAR(curvature.x(), 2 * kDistortion * 200, 0.01 * 2 * kDistortion * 200);
  EXPECT_NEAR(curvature.y(), 0, 1e-8);
}

TEST(LineBend, FewPointsTellNothing) {
  const std::vector<Eigen::Vector2d> few = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {2, 3}};
  EXPECT_EQ(LineBend(few, few).Curvature({0, 0}, {1, 0}), Eigen::Vector2d(0, 0));
}

}  // namespace
}  // namespace stereomotion
