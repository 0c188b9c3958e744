#include "tests/support/calibration_scene.h"

#include <cmath>
#include <stdexcept>

#include "stereomotion/camera/sphere_projection.h"
#include "stereomotion/geometry/so3.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

RigCamera MakeCamera(const std::string& name, double side, const CameraModel& model) {
  RigCamera camera;
  camera.name = name;
  camera.width_px = 1280;
  camera.height_px = 1024;
  camera.model = model;
  // Beside each other, 1.2 m apart, turned towards the world's origin 2.5 m away.
  const double turn = side * 0.24;
  camera.cam_from_world.rotation = Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitZ()) *
                                   Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY());
  camera.cam_from_world.translation_mm = {-20 * side, 12, 2500};
  return camera;
}

CalibrationScene MakeScene(TargetType type) {
  CalibrationScene scene;
  scene.truth = MakeCalibrationRig();
  scene.setup.target.type = type;
  for (const RigCamera& camera : scene.truth.cameras) {
    CalibrationCamera asked;
    asked.name = camera.name;
    asked.width_px = camera.width_px;
    asked.height_px = camera.height_px;
    asked.free = {true, true, true, true, true, true, true, true, true};
    scene.setup.cameras.push_back(asked);
  }
  return scene;
}

// Everything of a scene that is seen from a world that another one moves.
void ChangeWorld(Rigid3 new_from_old, CalibrationScene& scene) {
  for (auto& camera : scene.truth.cameras) {
    camera.cam_from_world = camera.cam_from_world * new_from_old.Inverse();
  }
  for (auto& pose : scene.world_from_target) pose = new_from_old * pose;
}

Rigid3 RandomPlace(std::mt19937_64& rng, double tilt_rad) {
  const Eigen::Vector3d axis = NormalVector<3>(rng).normalized();
  return {ExpSO3(axis * Uniform(rng, 0.3, 1) * tilt_rad),
          {Uniform(rng, -380, 380), Uniform(rng, -250, 250), Uniform(rng, -350, 350)}};
}

constexpr double kCircleRadiusMm = 18;

// Centroid and size of a circle's image, by many points of its disc: not the calibrator's way.
TargetObservation SeeCircle(const RigCamera& camera, const Rigid3& world_from_target,
                            const Eigen::Vector3d& center_mm) {
  constexpr int kSteps = 24;
  TargetObservation seen;
  double area_px2 = 0;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const double radius = kCircleRadiusMm * std::sqrt((i / kSteps + 0.5) / kSteps);
    const double angle = 2 * M_PI * (i % kSteps) / kSteps;
    const Eigen::Vector3d p =
        center_mm + radius * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
    Eigen::Matrix<double, 2, 3> d;
    const auto pixel = ProjectWorldPoint(camera, world_from_target * p, &d);
    if (!pixel) return seen;
    const Eigen::Matrix3d axes = world_from_target.rotation.toRotationMatrix();
    const double stretch = std::abs((d * axes.leftCols<2>()).determinant());
    seen.pixel_px += stretch * *pixel;
    area_px2 += stretch;
  }
  seen.pixel_px /= area_px2;
  const double share = kCircleRadiusMm * kCircleRadiusMm / (kSteps * kSteps);
  seen.diameter_px = 2 * std::sqrt(area_px2 * share);
  return seen;
}

std::optional<Eigen::Vector2d> See(const RigCamera& camera, const Target& target,
                                   const Eigen::Vector3d& p_in_world_mm) {
  const Eigen::Vector3d p_in_cam_mm = camera.cam_from_world * p_in_world_mm;
  std::optional<Eigen::Vector2d> pixel = camera.model.Project(p_in_cam_mm);
  if (pixel && HasBalls(target.type)) {
    const auto ball = ProjectSphere(camera.model, p_in_cam_mm, target.ball_diameter_mm / 2);
    pixel = ball ? std::optional(ball->outline.center_px) : std::nullopt;
  }
  const bool inside = pixel && pixel->minCoeff() > 5 && pixel->x() < camera.width_px - 6 &&
                      pixel->y() < camera.height_px - 6;
  return inside ? pixel : std::nullopt;
}

}  // namespace

Rig MakeCalibrationRig() {
  CameraModel left{1643.4, 1643.7, 639.1, 494.3, -0.0703, 0.0871, 0.00058, -0.00032, -0.0011};
  CameraModel right{1646.6, 1647.0, 651.0, 501.2, -0.0485, 0.1224, 0.00044, -0.00051, 0.0159};
  return {{MakeCamera("cam0", 1, left), MakeCamera("cam1", -1, right)}, {}};
}

CalibrationScene MakeControlPointScene(int points, double survey_sigma_mm, int images) {
  CalibrationScene scene = MakeScene(TargetType::kControlPoints);
  scene.setup.target.ball_diameter_mm = 14;
  std::mt19937_64 rng(7);
  for (int i = 0; i < points; ++i) {
    TargetPoint point;
    point.id = "P" + std::to_string(i);
    point.xyz_mm = {Uniform(rng, -500, 500), Uniform(rng, -350, 350), Uniform(rng, -350, 350)};
    point.sigma_mm = survey_sigma_mm;
    scene.setup.target.points.push_back(point);
  }
  scene.world_from_target.assign(images, Rigid3{});
  scene.sigma_px = 0.004;
  return scene;
}

CalibrationScene MakeBoardScene(int views) {
  CalibrationScene scene = MakeScene(TargetType::kAprilTagGrid);
  Target& target = scene.setup.target;
  target.rows = 5;
  target.cols = 6;
  target.tag_size_mm = 60;
  target.tag_spacing_mm = 18;
  target.family = "tag36h11";
  target.points = MakeBoardPoints(target);
  std::mt19937_64 rng(8);
  const Rigid3 board_centered{Eigen::Quaterniond::Identity(), {-225, -186, 0}};
  for (int i = 0; i < views; ++i) {
    scene.world_from_target.push_back(RandomPlace(rng, 0.7) * board_centered);
  }
  ChangeWorld(scene.world_from_target[0].Inverse(), scene);
  scene.sigma_px = 0.03;
  return scene;
}

CalibrationScene MakeCircleScene(int views) {
  CalibrationScene scene = MakeScene(TargetType::kCircleGrid);
  Target& target = scene.setup.target;
  target.rows = 7;
  target.cols = 9;
  target.spacing_mm = 50;
  target.points = MakeBoardPoints(target);
  std::mt19937_64 rng(10);
  const Rigid3 board_centered{Eigen::Quaterniond::Identity(), {-200, -150, 0}};
  for (int i = 0; i < views; ++i) {
    Rigid3 place = RandomPlace(rng, 0.8);
    place.translation_mm.z() -= 900;
    place.translation_mm.head<2>() *= 0.4;
    scene.world_from_target.push_back(place * board_centered);
  }
  ChangeWorld(scene.world_from_target[0].Inverse(), scene);
  scene.sigma_px = 0.01;
  return scene;
}

CalibrationScene MakeWandScene(int views) {
  CalibrationScene scene = MakeScene(TargetType::kWand);
  scene.setup.target.ball_diameter_mm = 14;
  scene.setup.target.points = MakeWandPoints({0, 150, 400});
  std::mt19937_64 rng(9);
  const Rigid3 wand_centered{Eigen::Quaterniond::Identity(), {-200, 0, 0}};
  for (int i = 0; i < views; ++i) {
    Rigid3 place = RandomPlace(rng, 0);
    place.rotation = ExpSO3(NormalVector<3>(rng) * 0.9);
    scene.world_from_target.push_back(place * wand_centered);
  }
  ChangeWorld(scene.truth.cameras[0].cam_from_world, scene);
  scene.sigma_px = 0.01;
  return scene;
}

CalibrationDraw Draw(const CalibrationScene& scene, std::mt19937_64& rng) {
  CalibrationDraw draw{scene.setup, {}};
  for (auto& point : draw.setup.target.points) {
    point.xyz_mm += point.sigma_mm * NormalVector<3>(rng);
  }
  const Target& target = scene.setup.target;
  for (int camera = 0; camera < static_cast<int>(scene.truth.cameras.size()); ++camera) {
    for (int view = 0; view < static_cast<int>(scene.world_from_target.size()); ++view) {
      for (int point = 0; point < static_cast<int>(target.points.size()); ++point) {
        auto pixel = See(scene.truth.cameras[camera], target,
                         scene.world_from_target[view] * target.points[point].xyz_mm);
        if (!pixel) continue;
        TargetObservation o{camera, view, point};
        if (target.type == TargetType::kCircleGrid) {
          const auto circle = SeeCircle(scene.truth.cameras[camera], scene.world_from_target[view],
                                        target.points[point].xyz_mm);
          pixel = circle.pixel_px;
          o.diameter_px = circle.diameter_px;
        }
        o.pixel_px = *pixel + scene.sigma_px * NormalVector<2>(rng);
        o.covariance_px2 = scene.sigma_px * scene.sigma_px * Eigen::Matrix2d::Identity();
        draw.observations.push_back(o);
      }
    }
  }
  return draw;
}

Eigen::VectorXd RigError(const Rig& estimate, const Rig& truth) {
  if (!estimate.covariance) throw std::invalid_argument("RigError: the rig has no covariance");
  const auto& parameters = estimate.covariance->parameters;
  Eigen::VectorXd error(static_cast<Eigen::Index>(parameters.size()));
  for (Eigen::Index i = 0; i < error.size(); ++i) {
    const RigParameter& parameter = parameters[i];
    const RigCamera& a = truth.cameras[parameter.camera];
    const RigCamera& b = estimate.cameras[parameter.camera];
    const double model_error[] = {
        b.model.fx_px - a.model.fx_px, b.model.fy_px - a.model.fy_px, b.model.cx_px - a.model.cx_px,
        b.model.cy_px - a.model.cy_px, b.model.k1 - a.model.k1,       b.model.k2 - a.model.k2,
        b.model.p1 - a.model.p1,       b.model.p2 - a.model.p2,       b.model.k3 - a.model.k3};
    const Vector6d pose_error = PerturbationBetween(a.cam_from_world, b.cam_from_world);
    error[i] = parameter.index < CameraModel::kNumParameters
                   ? model_error[parameter.index]
                   : pose_error[parameter.index - CameraModel::kNumParameters];
  }
  return error;
}

}  // namespace stereomotion::testing
