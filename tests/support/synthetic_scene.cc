#include "tests/support/synthetic_scene.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "stereomotion/camera/sphere_projection.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

Rigid3 LookAtOrigin(const Eigen::Vector3d& position_mm) {
  Eigen::Matrix3d world_from_cam;
  world_from_cam.col(2) = -position_mm.normalized();
  world_from_cam.col(0) = Eigen::Vector3d::UnitY().cross(world_from_cam.col(2)).normalized();
  world_from_cam.col(1) = world_from_cam.col(2).cross(world_from_cam.col(0));
  return Rigid3{Eigen::Quaterniond(world_from_cam), position_mm}.Inverse();
}

RigCamera MakeCamera(const std::string& name, const CameraModel& model,
                     const Eigen::Vector3d& position_mm) {
  RigCamera camera;
  camera.name = name;
  camera.width_px = 1280;
  camera.height_px = 1024;
  camera.model = model;
  camera.cam_from_world = LookAtOrigin(position_mm);
  return camera;
}

Rod MakeRod(const std::string& name, const Eigen::Vector3d& start_mm,
            const Eigen::Vector3d& direction, const std::vector<double>& places_mm) {
  Rod rod;
  rod.name = name;
  rod.ball_diameter_mm = 14;
  for (const double place_mm : places_mm) {
    rod.balls_in_body_mm.emplace_back(start_mm + place_mm * direction.normalized());
  }
  return rod;
}

struct Seen {
  BallId id;
  BallObservation ball;
  bool is_false = false;
};

Eigen::Matrix2d DrawCovariance(double sigma_px, std::mt19937_64& rng) {
  const double angle_rad = Uniform(rng, 0, 3.14159);
  const double ratio = Uniform(rng, 0.7, 1.4);
  const Eigen::Rotation2Dd turn(angle_rad);
  const Eigen::Vector2d sigmas_px = sigma_px * Eigen::Vector2d(ratio, 1 / ratio);
  return turn.toRotationMatrix() * sigmas_px.cwiseAbs2().asDiagonal() *
         turn.toRotationMatrix().transpose();
}

bool Inside(const RigCamera& camera, const ImageEllipse& outline) {
  const double margin_px = outline.semi_major_px;
  return outline.center_px.x() > margin_px && outline.center_px.y() > margin_px &&
         outline.center_px.x() < camera.width_px - 1 - margin_px &&
         outline.center_px.y() < camera.height_px - 1 - margin_px;
}

std::vector<Seen> SeeBalls(const RigCamera& camera, const Body& body, const Rigid3& world_from_body,
                           const std::vector<std::vector<bool>>& hidden,
                           const ObserveOptions& options, std::mt19937_64& rng) {
  std::vector<Seen> seen;
  for (std::size_t r = 0; r < body.rods.size(); ++r) {
    const Rod& rod = body.rods[r];
    for (std::size_t b = 0; b < rod.balls_in_body_mm.size(); ++b) {
      const auto sphere = ProjectSphere(
          camera.model, camera.cam_from_world * (world_from_body * rod.balls_in_body_mm[b]),
          rod.ball_diameter_mm / 2);
      if (!sphere || hidden[r][b] || !Inside(camera, sphere->outline)) continue;
      Seen one{{static_cast<int>(r), static_cast<int>(b)}, {}, false};
      one.ball.covariance_px2 = DrawCovariance(options.sigma_px, rng);
      const Eigen::Matrix2d root = one.ball.covariance_px2.llt().matrixL();
      one.ball.center_px =
          sphere->outline.center_px + options.noise_scale * root * NormalVector<2>(rng);
      one.ball.semi_major_px = sphere->outline.semi_major_px;
      one.ball.semi_minor_px = sphere->outline.semi_minor_px;
      seen.push_back(one);
    }
  }
  return seen;
}

/// A merged blob is no ball any more: its centre is somewhere between, and the detector says so.
void MergeOverlaps(std::vector<Seen>& seen) {
  std::vector<std::pair<Seen*, Eigen::Vector2d>> merged;
  for (Seen& a : seen) {
    for (Seen& b : seen) {
      if (&a == &b || (a.ball.center_px - b.ball.center_px).norm() >
                          a.ball.semi_major_px + b.ball.semi_major_px) {
        continue;
      }
      a.ball.status = b.ball.status = BlobStatus::kPartly;
      merged.emplace_back(&a, (b.ball.center_px - a.ball.center_px) / 3);
    }
  }
  for (const auto& [one, bias_px] : merged) one->ball.center_px += bias_px;
}

void AddFalseBalls(const RigCamera& camera, const ObserveOptions& options, std::mt19937_64& rng,
                   std::vector<Seen>& seen) {
  for (int i = 0; i < options.false_balls; ++i) {
    Seen one;
    one.is_false = true;
    one.ball.center_px = {Uniform(rng, 10, camera.width_px - 10),
                          Uniform(rng, 10, camera.height_px - 10)};
    one.ball.covariance_px2 = DrawCovariance(options.sigma_px, rng);
    one.ball.semi_major_px = one.ball.semi_minor_px = Uniform(rng, 3.5, 6);
    seen.push_back(one);
  }
}

void Shuffle(int camera, std::vector<Seen>& seen, std::mt19937_64& rng,
             std::vector<BallObservation>& list, std::vector<BallAssignment>& truth) {
  for (std::size_t i = seen.size(); i > 1; --i) std::swap(seen[i - 1], seen[rng() % i]);
  for (const Seen& one : seen) {
    if (!one.is_false && one.ball.status == BlobStatus::kOk) {
      truth.push_back({one.id, camera, static_cast<int>(list.size())});
    }
    list.push_back(one.ball);
  }
}

std::vector<std::vector<bool>> DrawHidden(const Body& body, const ObserveOptions& options,
                                          const std::vector<std::vector<bool>>& keep,
                                          std::mt19937_64& rng) {
  std::vector<std::vector<bool>> hidden = keep;
  for (std::size_t r = 0; r < body.rods.size(); ++r) {
    for (std::size_t b = 0; b < hidden[r].size(); ++b) {
      hidden[r][b] = !keep[r][b] && Uniform(rng, 0, 1) < options.hide_probability;
    }
  }
  return hidden;
}

std::vector<std::vector<bool>> DrawKept(const Body& body, int per_rod, std::mt19937_64& rng) {
  std::vector<std::vector<bool>> keep;
  for (const Rod& rod : body.rods) {
    std::vector<bool> kept(rod.balls_in_body_mm.size(), false);
    for (int i = 0; i < per_rod;) {
      const std::size_t b = rng() % kept.size();
      if (kept[b]) continue;
      kept[b] = true;
      ++i;
    }
    keep.push_back(kept);
  }
  return keep;
}

}  // namespace

Rig MakeConvergingRig() {
  Rig rig;
  rig.cameras = {MakeCamera("cam0", {1643, 1644, 639, 494, -0.07, 0.087, 5.8e-4, -3.2e-4, -1.1e-3},
                            {-440, 30, -2460}),
                 MakeCamera("cam1", {1647, 1646, 651, 501, -0.05, 0.12, 4.4e-4, -5e-4, 0.016},
                            {440, -20, -2460})};
  return rig;
}

Body MakeTwoRodBody() {
  Body body;
  body.name = "plate";
  body.rods = {MakeRod("A", {-157, -49, -113}, {0.999, 0.024, 0.037}, {0, 58, 154, 288, 362}),
               MakeRod("B", {-178, 83, 169}, {0.942, -0.168, -0.29}, {0, 112, 166, 250, 384})};
  return body;
}

Body MakeRodBody(const std::vector<double>& places_mm) {
  Body body;
  body.name = "rod";
  body.rods = {MakeRod("A", {20, -15, 30}, {0.6, 0.8, 0}, places_mm)};
  return body;
}

Body MakeEquallySpacedBody() {
  const std::vector<double> places_mm = {0, 60, 120, 180, 240};
  Body body;
  body.name = "ladder";
  body.rods = {MakeRod("A", {-120, -60, 0}, {1, 0, 0}, places_mm),
               MakeRod("B", {-120, 60, 20}, {1, 0, 0}, places_mm)};
  return body;
}

Rigid3 RandomPose(std::mt19937_64& rng, double range_mm) {
  const Eigen::Vector4d q = NormalVector<4>(rng).normalized();
  return {Eigen::Quaterniond(q[0], q[1], q[2], q[3]),
          Eigen::Vector3d(Uniform(rng, -range_mm, range_mm), Uniform(rng, -range_mm, range_mm),
                          Uniform(rng, -range_mm, range_mm))};
}

ObservedPair Observe(const RigCamera& left, const RigCamera& right, const Body& body,
                     const Rigid3& world_from_body, const ObserveOptions& options,
                     std::mt19937_64& rng) {
  ObservedPair pair;
  const auto keep = DrawKept(body, options.min_per_rod, rng);
  for (int camera = 0; camera < 2; ++camera) {
    const RigCamera& one = camera == 0 ? left : right;
    const auto hidden = DrawHidden(body, options, keep, rng);
    std::vector<Seen> seen = SeeBalls(one, body, world_from_body, hidden, options, rng);
    if (options.merge_overlaps) MergeOverlaps(seen);
    AddFalseBalls(one, options, rng, seen);
    Shuffle(camera, seen, rng, camera == 0 ? pair.left : pair.right, pair.truth);
  }
  return pair;
}

double ChiSquareBound(double dof, double z) {
  const double a = 2 / (9 * dof);
  return dof * std::pow(1 - a + z * std::sqrt(a), 3);
}

}  // namespace stereomotion::testing
