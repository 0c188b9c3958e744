#include <gtest/gtest.h>

#include <algorithm>

#include "stereomotion/motion/refine_structure.h"
#include "structure_case.h"

namespace stereomotion::testing {
namespace {

constexpr std::size_t kBalls = 5;

/// Leaves the first rod of the scene's body only.
MotionData RodOnly(MotionData data) {
  data.balls_in_body_mm.resize(kBalls);
  for (MotionFrame& frame : data.frames) {
    auto& points = frame.image_points;
    const auto is_other = [](const ImagePoint& point) {
      return point.ball >= static_cast<int>(kBalls);
    };
    points.erase(std::remove_if(points.begin(), points.end(), is_other), points.end());
  }
  return data;
}

/// Finds where the balls are along the rod, counted from their mean.
Eigen::VectorXd Places(const std::vector<Eigen::Vector3d>& balls_mm) {
  const Eigen::Matrix3Xd columns = Columns(balls_mm);
  const Eigen::Vector3d along = (balls_mm.back() - balls_mm.front()).normalized();
  return (columns.colwise() - columns.rowwise().mean().eval()).transpose() * along;
}

Eigen::MatrixXd CovarianceOfPlaces(const Structure& structure) {
  const auto& balls_mm = structure.balls_in_body_mm;
  const Eigen::Vector3d along = (balls_mm.back() - balls_mm.front()).normalized();
  Eigen::MatrixXd to_places = Eigen::MatrixXd::Zero(kBalls, 3 * kBalls);
  for (Eigen::Index i = 0; i < to_places.rows(); ++i) {
    to_places.block<1, 3>(i, 3 * i) = along.transpose();
  }
  return to_places * structure.covariance_mm2 * to_places.transpose();
}

/// Shifts the balls along their rod by up to some tenths of a millimetre.
std::vector<Eigen::Vector3d> Stretched(std::vector<Eigen::Vector3d> rod_mm, std::mt19937_64& rng) {
  const Eigen::Vector3d along = (rod_mm.back() - rod_mm.front()).normalized();
  for (Eigen::Vector3d& ball : rod_mm) ball += 0.3 * NormalVector<1>(rng)[0] * along;
  return rod_mm;
}

TEST(RefineRod, ExactPointsGiveTheExactRod) {
  auto rng = MakeTestRng();
  const MotionScene scene = MakeMotionScene(PrecessionMotion(), rng);
  MotionData data = RodOnly(scene.exact);
  const auto truth_mm = data.balls_in_body_mm;
  data.balls_in_body_mm = Stretched(truth_mm, rng);
  const auto structure = RefineStructure(data);
  ASSERT_TRUE(structure);
  EXPECT_LT((Places(structure->balls_in_body_mm) - Places(truth_mm)).norm(), 1e-6);
  EXPECT_LT(structure->chi2, 1e-6);
  for (std::size_t i = 0; i < data.frames.size(); ++i) {
    const Eigen::Vector3d ball = structure->poses[i] * structure->balls_in_body_mm[3];
    EXPECT_LT((ball - scene.truth[i].world_from_body * truth_mm[3]).norm(), 1e-5);
  }
}

TEST(RefineRod, CovarianceIsTheSpread) {
  auto rng = MakeTestRng();
  const MotionScene scene = MakeMotionScene(PrecessionMotion(), rng);
  const MotionData exact = RodOnly(scene.exact);
  const Eigen::VectorXd truth_mm = Places(exact.balls_in_body_mm);
  constexpr int kRepetitions = 200;
  ErrorStatistics errors, residuals;
  for (int i = 0; i < kRepetitions; ++i) {
    const auto start_mm = Stretched(exact.balls_in_body_mm, rng);
    MotionData data = RodOnly(UnknownBody(scene, scene.exact.balls_in_body_mm, rng));
    data.balls_in_body_mm = start_mm;
    const auto structure = RefineStructure(data);
    ASSERT_TRUE(structure);
    const Eigen::VectorXd error_mm = Places(structure->balls_in_body_mm) - truth_mm;
    constexpr Eigen::Index kFree = kBalls - 1;  // the mean is the gauge's
    errors.Add(error_mm.head(kFree), CovarianceOfPlaces(*structure).topLeftCorner(kFree, kFree));
    residuals.Add(Eigen::VectorXd::Constant(1, structure->chi2 - structure->dof),
                  Eigen::MatrixXd::Constant(1, 1, 2.0 * structure->dof));
  }
  EXPECT_TRUE(IsConsistent(errors, FamilyZ(2)));
  EXPECT_TRUE(IsConsistent(residuals, FamilyZ(2)));
}

}  // namespace
}  // namespace stereomotion::testing
