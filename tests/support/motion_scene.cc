#include "tests/support/motion_scene.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "stereomotion/geometry/so3.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

constexpr double kNsPerSecond = 1e9;

Eigen::Matrix2d DrawCovariance(double sigma_px, std::mt19937_64& rng) {
  const double ratio = Uniform(rng, 0.7, 1.4);
  const Eigen::Vector2d sigmas_px = sigma_px * Eigen::Vector2d(ratio, 1 / ratio);
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(Uniform(rng, 0, M_PI)).toRotationMatrix();
  return turn * sigmas_px.cwiseAbs2().asDiagonal() * turn.transpose();
}

/// Rows of a point's whitened residual with respect to the pose's perturbation.
Eigen::Matrix<double, 3, 6> PointByPose(const Rigid3& world_from_body,
                                        const Eigen::Vector3d& ball_mm) {
  Eigen::Matrix<double, 3, 6> jacobian;  // p = Exp(δθ) R b + t + δt
  jacobian << -Hat(world_from_body.rotation * ball_mm), Eigen::Matrix3d::Identity();
  return jacobian;
}

/// Whitened Jacobian of a frame's points and, row by row, the whitening of the noise.
struct Weighed {
  Eigen::MatrixXd jacobian, whitening;
  void Add(const Eigen::MatrixXd& rows, const Eigen::MatrixXd& covariance) {
    const Eigen::Index n = rows.rows(), at = jacobian.rows();
    const Eigen::MatrixXd root = covariance.llt().matrixL().solve(Eigen::MatrixXd::Identity(n, n));
    jacobian.conservativeResize(at + n, 6);
    jacobian.bottomRows(n) = root * rows;
    const Eigen::MatrixXd before = whitening;
    whitening = Eigen::MatrixXd::Zero(at + n, at + n);
    whitening.topLeftCorner(at, at) = before;
    whitening.bottomRightCorner(n, n) = root;
  }
};

void SeeImagePoints(const MotionData& data, double sigma_px, std::mt19937_64& rng,
                    MotionFrame& frame, Weighed& weighed) {
  for (int camera = 0; camera < 2; ++camera) {
    const RigCamera& one = data.rig.cameras[static_cast<std::size_t>(camera)];
    for (std::size_t i = 0; i < data.balls_in_body_mm.size(); ++i) {
      const Eigen::Vector3d& ball_mm = data.balls_in_body_mm[i];
      Eigen::Matrix<double, 2, 3> by_point;
      const auto center_px =
          ProjectWorldPoint(one, frame.pose.world_from_body * ball_mm, &by_point);
      const Eigen::Matrix2d covariance_px2 = DrawCovariance(sigma_px, rng);
      if (!center_px || center_px->minCoeff() < 0 || center_px->x() > one.width_px - 1 ||
          center_px->y() > one.height_px - 1) {
        throw std::logic_error("a motion of the test leaves the images");
      }
      frame.image_points.push_back({camera, static_cast<int>(i), *center_px, covariance_px2});
      weighed.Add(by_point * PointByPose(frame.pose.world_from_body, ball_mm), covariance_px2);
    }
  }
}

void SeeSpacePoints(const MotionData& data, double sigma_mm, MotionFrame& frame, Weighed& weighed) {
  const Eigen::Matrix3d covariance_mm2 = sigma_mm * sigma_mm * Eigen::Matrix3d::Identity();
  for (std::size_t i = 0; i < data.balls_in_body_mm.size(); ++i) {
    const Eigen::Vector3d& ball_mm = data.balls_in_body_mm[i];
    frame.space_points.push_back(
        {static_cast<int>(i), frame.pose.world_from_body * ball_mm, covariance_mm2});
    weighed.Add(PointByPose(frame.pose.world_from_body, ball_mm), covariance_mm2);
  }
}

void SeeFrame(std::size_t index, const SceneOptions& options, std::mt19937_64& rng,
              MotionScene& scene) {
  MotionFrame frame;
  const MotionTruth& truth = scene.truth[index];
  frame.pose.frame = static_cast<std::int64_t>(index);
  frame.pose.timestamp_ns = std::llround(truth.time_s * kNsPerSecond);
  frame.pose.measured = true;
  frame.pose.world_from_body = truth.world_from_body;
  Weighed weighed;
  if (options.with_space_points) {
    SeeSpacePoints(scene.exact, options.sigma_mm, frame, weighed);
  } else {
    SeeImagePoints(scene.exact, options.sigma_px, rng, frame, weighed);
  }
  const Matrix6d information = weighed.jacobian.transpose() * weighed.jacobian;
  frame.pose.covariance = information.llt().solve(Matrix6d::Identity());
  scene.pose_from_points.emplace_back(frame.pose.covariance * weighed.jacobian.transpose() *
                                      weighed.whitening);
  scene.exact.frames.push_back(frame);
}

}  // namespace

MotionScene MakeMotionScene(const MotionPlan& plan, std::mt19937_64& rng,
                            const SceneOptions& options) {
  return MakeMotionScene(plan, TrueMotion(plan), rng, options);
}

MotionScene MakeMotionScene(const MotionPlan& plan, std::vector<MotionTruth> truth,
                            std::mt19937_64& rng, const SceneOptions& options) {
  MotionScene scene;
  scene.plan = plan;
  scene.truth = std::move(truth);
  scene.exact.rig = MakeConvergingRig();
  scene.centroid_in_body_mm.setZero();
  for (const Rod& rod : MakeTwoRodBody().rods) {
    for (const Eigen::Vector3d& ball_mm : rod.balls_in_body_mm) {
      scene.exact.balls_in_body_mm.push_back(ball_mm);
      scene.centroid_in_body_mm += ball_mm;
    }
  }
  scene.centroid_in_body_mm /= static_cast<double>(scene.exact.balls_in_body_mm.size());
  for (std::size_t i = 0; i < scene.truth.size(); ++i) SeeFrame(i, options, rng, scene);
  return scene;
}

MotionData Observed(const MotionScene& scene, std::mt19937_64& rng) {
  MotionData data = scene.exact;
  for (std::size_t i = 0; i < data.frames.size(); ++i) {
    MotionFrame& frame = data.frames[i];
    Eigen::VectorXd noise(scene.pose_from_points[i].cols());
    Eigen::Index row = 0;
    for (ImagePoint& point : frame.image_points) {
      const Eigen::Matrix2d root = point.covariance_px2.llt().matrixL();
      noise.segment<2>(row) = root * NormalVector<2>(rng);
      point.center_px += noise.segment<2>(row);
      row += 2;
    }
    for (SpacePoint& point : frame.space_points) {
      const Eigen::Matrix3d root = point.covariance_mm2.llt().matrixL();
      noise.segment<3>(row) = root * NormalVector<3>(rng);
      point.p_in_world_mm += noise.segment<3>(row);
      row += 3;
    }
    frame.pose.world_from_body =
        Perturb(frame.pose.world_from_body, scene.pose_from_points[i] * noise);
  }
  return data;
}

MotionData SeenOtherwise(const MotionScene& scene, const Rig& true_rig,
                         const std::vector<Eigen::Vector3d>& true_balls_mm) {
  MotionData data = scene.exact;
  for (std::size_t i = 0; i < data.frames.size(); ++i) {
    MotionFrame& frame = data.frames[i];
    Eigen::VectorXd shift(scene.pose_from_points[i].cols());
    Eigen::Index row = 0;
    for (ImagePoint& point : frame.image_points) {
      const Eigen::Vector2d seen_px =
          ProjectWorldPoint(
              true_rig.cameras[static_cast<std::size_t>(point.camera)],
              scene.truth[i].world_from_body * true_balls_mm[static_cast<std::size_t>(point.ball)])
              .value();
      shift.segment<2>(row) = seen_px - point.center_px;
      point.center_px = seen_px;
      row += 2;
    }
    frame.pose.world_from_body =
        Perturb(frame.pose.world_from_body, scene.pose_from_points[i] * shift);
  }
  return data;
}

MotionData PosesOnly(MotionData data) {
  for (MotionFrame& frame : data.frames) {
    frame.image_points.clear();
    frame.space_points.clear();
  }
  return data;
}

}  // namespace stereomotion::testing
