#include "learn_shape.h"

#include <algorithm>
#include <tuple>

#include "motion/sort_into_rods.h"
#include "seen_balls.h"
#include "stereomotion/camera/sphere_projection.h"

namespace stereomotion {
namespace {

std::size_t FirstFrame(const BallGroup& group) {
  std::size_t frame = 0;
  while (!group.world_from_group[frame]) ++frame;
  return frame;
}

/// Turns the group into the world's axes at its first frame.
std::vector<Eigen::Vector3d> BallsAsSeenFirst(const BallGroup& group) {
  const Rigid3& world_from_group = *group.world_from_group[FirstFrame(group)];
  std::vector<Eigen::Vector3d> balls_mm;
  for (const CloudPoint& ball : group.balls) balls_mm.push_back(world_from_group * ball.p_mm);
  return balls_mm;
}

double LargestSigma(const BallGroup& group) {
  double sigma_mm = 0;
  for (const CloudPoint& ball : group.balls) sigma_mm = std::max(sigma_mm, ball.sigma_mm);
  return sigma_mm;
}

/// Orders each rod's balls and the rods themselves by where they lie.
void OrderRods(const std::vector<Eigen::Vector3d>& balls_mm, std::vector<std::vector<int>>& rods) {
  const auto at = [&](int ball) -> const Eigen::Vector3d& {
    return balls_mm[static_cast<std::size_t>(ball)];
  };
  for (std::vector<int>& rod : rods) {
    const Eigen::Vector3d along_mm = at(rod.back()) - at(rod.front());
    Eigen::Index axis = 0;
    along_mm.cwiseAbs().maxCoeff(&axis);
    if (along_mm[axis] < 0) std::reverse(rod.begin(), rod.end());
  }
  std::sort(rods.begin(), rods.end(), [&](const auto& x, const auto& y) {
    const Eigen::Vector3d &p = at(x.front()), &q = at(y.front());
    return std::make_tuple(p.x(), p.y(), p.z()) < std::make_tuple(q.x(), q.y(), q.z());
  });
}

/// A, B, …, Z, A1, B1, ….
std::string RodName(std::size_t i) {
  constexpr std::size_t kLetters = 26;
  const std::string letter(1, static_cast<char>('A' + i % kLetters));
  return i < kLetters ? letter : letter + std::to_string(i / kLetters);
}

void PlaceBody(const BallGroup& group, const std::vector<Eigen::Vector3d>& seen_first_mm,
               const std::vector<std::vector<int>>& rods, LearnedShape& shape) {
  Eigen::Vector3d mean_mm = Eigen::Vector3d::Zero();
  for (const auto& rod : rods) {
    shape.group_balls.insert(shape.group_balls.end(), rod.begin(), rod.end());
  }
  for (const int ball : shape.group_balls) {
    mean_mm += seen_first_mm[static_cast<std::size_t>(ball)] /
               static_cast<double>(shape.group_balls.size());
  }
  for (const auto& balls : rods) {
    Rod rod;
    rod.name = RodName(shape.body.rods.size());
    for (const int ball : balls) {
      rod.balls_in_body_mm.emplace_back(seen_first_mm[static_cast<std::size_t>(ball)] - mean_mm);
    }
    shape.body.rods.push_back(std::move(rod));
  }
  const Rigid3 group_from_body = group.world_from_group[FirstFrame(group)]->Inverse() *
                                 Rigid3{Eigen::Quaterniond::Identity(), mean_mm};
  for (const auto& pose : group.world_from_group) {
    shape.world_from_body.push_back(pose ? std::optional<Rigid3>(*pose * group_from_body)
                                         : std::nullopt);
  }
}

}  // namespace

std::optional<LearnedShape> ShapeOf(const BallGroup& group, const std::vector<LearnPair>& pairs,
                                    const RigCamera& left, const RigCamera& right,
                                    double diameter_mm) {
  const std::vector<Eigen::Vector3d> seen_first_mm = BallsAsSeenFirst(group);
  RodSortOptions options;
  constexpr double kSigmas = 5;
  options.slack_mm = kSigmas * LargestSigma(group);
  SortedRods sorted = SortIntoRods(seen_first_mm, options);
  if (sorted.rods.empty()) return std::nullopt;
  OrderRods(seen_first_mm, sorted.rods);
  LearnedShape shape;
  shape.left_over = static_cast<int>(sorted.left_over.size());
  PlaceBody(group, seen_first_mm, sorted.rods, shape);
  if (diameter_mm > 0) {
    for (Rod& rod : shape.body.rods) rod.ball_diameter_mm = diameter_mm;
  } else {
    MeasureDiameters(group, pairs, {&left, &right}, shape);
  }
  return shape;
}

MotionData ObservationsOfShape(const LearnedShape& shape, const BallGroup& group,
                               const std::vector<LearnPair>& pairs, const MeasureSetup& setup) {
  MotionData data;
  data.rig = setup.rig;
  data.left_camera = setup.left_camera;
  data.right_camera = setup.right_camera;
  data.structure_known = false;
  data.balls_in_body_mm = BallsOf(shape.body);
  for (std::size_t f = 0; f < pairs.size(); ++f) {
    MotionFrame frame;
    frame.pose.frame = pairs[f].frame;
    frame.pose.timestamp_ns = pairs[f].timestamp_ns;
    frame.pose.measured = shape.world_from_body[f].has_value();
    if (frame.pose.measured) frame.pose.world_from_body = *shape.world_from_body[f];
    data.frames.push_back(std::move(frame));
  }
  ForEachSeen(
      shape, group, pairs,
      [&](std::size_t f, std::size_t side, std::size_t ball, const BallObservation& seen) {
        const int index = side == 0 ? setup.left_camera : setup.right_camera;
        const RigCamera& camera = setup.rig.cameras[static_cast<std::size_t>(index)];
        const double radius_mm = shape.body.rods[RodOfBall(shape.body, ball)].ball_diameter_mm / 2;
        const Eigen::Vector3d p_mm = *shape.world_from_body[f] * data.balls_in_body_mm[ball];
        const auto sphere = ProjectSphere(camera.model, camera.cam_from_world * p_mm, radius_mm);
        if (!sphere) return;
        data.frames[f].image_points.push_back({static_cast<int>(side), static_cast<int>(ball),
                                               seen.center_px - sphere->shift_px(),
                                               seen.covariance_px2});
      });
  return data;
}

}  // namespace stereomotion
