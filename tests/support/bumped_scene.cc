#include "tests/support/bumped_scene.h"

#include <Eigen/Eigenvalues>
#include <stdexcept>

#include "stereomotion/calibration/calibrate.h"
#include "stereomotion/geometry/so3.h"
#include "tests/support/calibration_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

void Move(const RigParameter& parameter, double step, Rig& rig) {
  RigCamera& camera = rig.cameras[parameter.camera];
  CameraModel& model = camera.model;
  double* const intrinsics[] = {&model.fx_px, &model.fy_px, &model.cx_px, &model.cy_px, &model.k1,
                                &model.k2,    &model.p1,    &model.p2,    &model.k3};
  if (parameter.index < CameraModel::kNumParameters) *intrinsics[parameter.index] += step;
}

}  // namespace

BumpedScene MakeBumpedScene(const Rig& truth, const Body& body, int frames) {
  BumpedScene scene;
  scene.truth = truth;
  scene.body = body;
  std::mt19937_64 rng(11);
  for (int i = 0; i < frames; ++i) scene.world_from_body.push_back(RandomPose(rng, 250));
  return scene;
}

void Bump(double turn_deg, double shift_mm, std::mt19937_64& rng, Rig& rig) {
  constexpr double kRadPerDeg = 0.017453292519943295;
  const Eigen::Vector3d axis = NormalVector<3>(rng).normalized();
  const Eigen::Vector3d shift = shift_mm * NormalVector<3>(rng).normalized();
  Rigid3& cam_from_world = rig.cameras[1].cam_from_world;
  cam_from_world = Rigid3{ExpSO3(turn_deg * kRadPerDeg * axis), shift} * cam_from_world;
}

std::vector<RefineFrame> See(const BumpedScene& scene, std::mt19937_64& rng) {
  std::vector<RefineFrame> frames;
  for (const Rigid3& pose : scene.world_from_body) {
    ObservedPair pair = Observe(scene.truth.cameras[0], scene.truth.cameras[1], scene.body, pose,
                                scene.observe, rng);
    RefineFrame& frame = frames.emplace_back();
    frame.frame = static_cast<std::int64_t>(frames.size()) - 1;
    frame.balls = {std::move(pair.left), std::move(pair.right)};
  }
  return frames;
}

Rig MakeCalibratedRig() {
  const CalibrationScene scene = MakeControlPointScene(30, 0.2, 2);
  std::mt19937_64 rng(12);
  const CalibrationDraw draw = Draw(scene, rng);
  CalibrateOptions options;
  options.folds = 0;
  const auto calibration = Calibrate(draw.setup, draw.observations, options);
  if (!calibration) throw std::runtime_error(calibration.error().text);
  Rig rig = scene.truth;
  rig.covariance = calibration->rig.covariance;
  return rig;
}

Rig DrawRig(const Rig& truth, std::mt19937_64& rng) {
  const RigCovariance& covariance = truth.covariance.value();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance.matrix);
  Eigen::VectorXd normal(covariance.matrix.rows());
  for (auto& number : normal) number = Normal(rng);
  const Eigen::VectorXd error =
      solver.eigenvectors() * (solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * normal);
  Rig rig = truth;
  std::vector<Vector6d> of_pose(rig.cameras.size(), Vector6d::Zero());
  for (std::size_t i = 0; i < covariance.parameters.size(); ++i) {
    const RigParameter& parameter = covariance.parameters[i];
    const double step = error[static_cast<Eigen::Index>(i)];
    Move(parameter, step, rig);
    const int row = parameter.index - CameraModel::kNumParameters;
    if (row >= 0) of_pose[parameter.camera][row] = step;
  }
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    rig.cameras[c].cam_from_world = Perturb(rig.cameras[c].cam_from_world, of_pose[c]);
  }
  return rig;
}

}  // namespace stereomotion::testing
