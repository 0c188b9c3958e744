#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include "pose/body_geometry.h"
#include "stereomotion/camera/sphere_projection.h"
#include "stereomotion/pose/acquire_pose.h"

namespace stereomotion {
namespace {

struct PredictedBall {
  BallId id;
  Eigen::Vector2d center_px;
  double diameter_px = 0;
};

std::vector<PredictedBall> PredictBalls(const RigCamera& camera, const Body& body,
                                        const Rigid3& world_from_body) {
  std::vector<PredictedBall> predicted;
  for (const BallId& id : AllBalls(body)) {
    const auto sphere = ProjectSphere(
        camera.model, camera.cam_from_world * (world_from_body * BallInBody(body, id)),
        BallRadius(body, id));
    if (!sphere) continue;
    predicted.push_back({id, sphere->outline.center_px,
                         sphere->outline.semi_major_px + sphere->outline.semi_minor_px});
  }
  return predicted;
}

/// A ball has the size that its depth says; what is only partly seen may have any.
bool SizeFits(const BallObservation& ball, const PredictedBall& predicted) {
  constexpr double kRatio = 1.6;  // blur and threshold change a small ball's size by no more
  if (ball.status != BlobStatus::kOk) return true;
  const double ratio = ball.diameter_px() / predicted.diameter_px;
  return ratio < kRatio && ratio > 1 / kRatio;
}

void AssignInCamera(int camera, const std::vector<PredictedBall>& predicted,
                    const std::vector<BallObservation>& balls, double gate_px,
                    std::vector<BallAssignment>& assignments) {
  const auto may_be = [&](const PredictedBall& p, const BallObservation& ball) {
    return (ball.center_px - p.center_px).squaredNorm() < gate_px * gate_px && SizeFits(ball, p);
  };
  // Only what lies near some prediction enters: the assignment costs the cube of its size.
  std::vector<int> near;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const auto fits = [&](const PredictedBall& p) { return may_be(p, balls[i]); };
    if (std::any_of(predicted.begin(), predicted.end(), fits)) near.push_back(static_cast<int>(i));
  }
  if (near.empty()) return;
  Eigen::MatrixXd cost_px2(static_cast<Eigen::Index>(predicted.size()),
                           static_cast<Eigen::Index>(near.size()));
  for (Eigen::Index row = 0; row < cost_px2.rows(); ++row) {
    for (Eigen::Index column = 0; column < cost_px2.cols(); ++column) {
      const PredictedBall& p = predicted[static_cast<std::size_t>(row)];
      const auto& ball = balls[static_cast<std::size_t>(near[static_cast<std::size_t>(column)])];
      cost_px2(row, column) = may_be(p, ball) ? (ball.center_px - p.center_px).squaredNorm()
                                              : std::numeric_limits<double>::infinity();
    }
  }
  const std::vector<int> columns = AssignOneToOne(cost_px2, gate_px * gate_px);
  for (std::size_t row = 0; row < predicted.size(); ++row) {
    if (columns[row] < 0) continue;
    assignments.push_back(
        {predicted[row].id, camera, near[static_cast<std::size_t>(columns[row])]});
  }
}

}  // namespace

std::vector<BallAssignment> AssignDetections(const RigCamera& left, const RigCamera& right,
                                             const Body& body,
                                             const std::vector<BallObservation>& left_balls,
                                             const std::vector<BallObservation>& right_balls,
                                             const Rigid3& world_from_body, double gate_px) {
  if (!(gate_px > 0)) throw std::invalid_argument("AssignDetections: the gate must be positive");
  std::vector<BallAssignment> assignments;
  AssignInCamera(0, PredictBalls(left, body, world_from_body), left_balls, gate_px, assignments);
  AssignInCamera(1, PredictBalls(right, body, world_from_body), right_balls, gate_px, assignments);
  return assignments;
}

}  // namespace stereomotion
