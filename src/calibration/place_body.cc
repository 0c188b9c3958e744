#include "place_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "stereomotion/calibration/intersect_rays.h"
#include "stereomotion/core/median.h"

namespace stereomotion {
namespace {

// A frame whose misfit is this many times the median: a ball was taken for another.
constexpr double kFarFactor = 5;
constexpr double kNearMm = 0.01;  // as good as exact, whatever the median

double Spread(const Eigen::Matrix3Xd& points) {
  return (points.colwise() - points.rowwise().mean()).norm();
}

// Lays the x axis along points that lie on a line.
Rigid3 AlignLine(const Eigen::Matrix3Xd& model_mm, const Eigen::Matrix3Xd& measured_mm) {
  const Eigen::Vector3d center = measured_mm.rowwise().mean();
  const Eigen::RowVectorXd place = model_mm.row(0).array() - model_mm.row(0).mean();
  const Eigen::Vector3d direction = (measured_mm.colwise() - center) * place.transpose();
  const Eigen::Quaterniond rotation =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), direction);
  return {rotation, center - rotation * model_mm.rowwise().mean()};
}

struct Placing {
  Rigid3 first_from_target;
  double misfit_mm = 0;  ///< RMS
};

Placing Place(const BodyTarget& target, const Eigen::Matrix3Xd& model_mm,
              const Eigen::Matrix3Xd& measured_mm) {
  Placing placing;
  placing.first_from_target = target.freedom == PoseFreedom::kLine
                                  ? AlignLine(model_mm, measured_mm)
                                  : AlignPoints(model_mm, measured_mm);
  for (Eigen::Index i = 0; i < model_mm.cols(); ++i) {
    placing.misfit_mm +=
        (placing.first_from_target * model_mm.col(i) - measured_mm.col(i)).squaredNorm();
  }
  placing.misfit_mm = std::sqrt(placing.misfit_mm / static_cast<double>(model_mm.cols()));
  return placing;
}

Eigen::Matrix3Xd ModelOf(const BodyTarget& target, const std::vector<int>& balls) {
  Eigen::Matrix3Xd model_mm(3, static_cast<Eigen::Index>(balls.size()));
  Eigen::Index column = 0;
  for (const int ball : balls) model_mm.col(column++) = target.points[ball].xyz_mm;
  return model_mm;
}

// The balls of a match in the first camera's frame, the distance of the cameras 1.
std::optional<Eigen::Matrix3Xd> Intersect(const std::vector<RigCamera>& cameras,
                                          const RodFrame& frame, const RodMatch& match) {
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(match.points.size()));
  Eigen::Index column = 0;
  for (const auto& [i, j] : match.points) {
    const auto point =
        IntersectRays(cameras, {{0, frame.pixels_px[0][i], Eigen::Matrix2d::Identity()},
                                {1, frame.pixels_px[1][j], Eigen::Matrix2d::Identity()}});
    if (!point) return std::nullopt;
    points.col(column++) = point->p_in_world_mm;
  }
  return points;
}

struct Named {
  PlacedFrame frame;
  Eigen::Matrix3Xd measured;  ///< the distance of the cameras 1
  double scale = 0;           ///< mm
  double misfit_mm = std::numeric_limits<double>::infinity();
};

Named NameBalls(const BodyTarget& target, const RodMatch& match, const Eigen::Matrix3Xd& measured) {
  Named best;
  best.measured = measured;
  for (const auto& balls : match.labellings) {
    const Eigen::Matrix3Xd model_mm = ModelOf(target, balls);
    const double scale = Spread(model_mm) / std::max(Spread(measured), 1e-300);
    const Placing placing = Place(target, model_mm, scale * measured);
    if (placing.misfit_mm >= best.misfit_mm) continue;
    best.misfit_mm = placing.misfit_mm;
    best.scale = scale;
    best.frame.balls = balls;
  }
  return best;
}

BodyTarget MakeLineTarget(const Rod& rod) {
  BodyTarget target;
  target.freedom = PoseFreedom::kLine;
  for (const Eigen::Vector3d& ball : rod.balls_in_body_mm) {
    BundlePoint point;
    point.xyz_mm.x() = (ball - rod.balls_in_body_mm.front()).norm();
    point.surveyed_mm = point.xyz_mm;
    // Across the line a ball tells nothing that the rod's pose does not, but how bent it is.
    point.sigma_mm.x() = rod.sigma_mm;
    point.ball_radius_mm = rod.ball_diameter_mm / 2;
    target.points.push_back(point);
  }
  return target;
}

}  // namespace

BodyTarget MakeBodyTarget(const Body& body) {
  if (body.rods.size() == 1) return MakeLineTarget(body.rods.front());
  BodyTarget target;
  for (const Rod& rod : body.rods) {
    for (const Eigen::Vector3d& ball : rod.balls_in_body_mm) {
      BundlePoint point;
      point.xyz_mm = point.surveyed_mm = ball;
      point.sigma_mm.setConstant(rod.sigma_mm);
      point.ball_radius_mm = rod.ball_diameter_mm / 2;
      target.points.push_back(point);
    }
  }
  return target;
}

std::optional<PlacedBody> PlaceBody(const std::vector<RigCamera>& rig, const BodyTarget& target,
                                    const std::vector<RodFrame>& frames,
                                    const ResolvedFrames& resolved) {
  std::vector<RigCamera> cameras = rig;
  cameras[0].cam_from_world = Rigid3{};
  cameras[1].cam_from_world = resolved.second_from_first;
  std::vector<Named> named;
  std::vector<double> scales, misfits_mm;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    if (resolved.match[f] < 0) continue;
    const RodMatch& match = frames[f].matches[resolved.match[f]];
    const auto measured = Intersect(cameras, frames[f], match);
    if (!measured) continue;
    named.push_back(NameBalls(target, match, *measured));
    named.back().frame.rod_frame = static_cast<int>(f);
    scales.push_back(named.back().scale);
    misfits_mm.push_back(named.back().misfit_mm);
  }
  if (named.empty()) return std::nullopt;
  const double scale = Median(scales),
               limit_mm = std::max(kNearMm, kFarFactor * Median(misfits_mm));
  PlacedBody placed;
  placed.second_from_first = resolved.second_from_first;
  placed.second_from_first.translation_mm *= scale;
  for (Named& one : named) {
    if (one.misfit_mm > limit_mm) continue;
    one.frame.first_from_target =
        Place(target, ModelOf(target, one.frame.balls), scale * one.measured).first_from_target;
    placed.frames.push_back(std::move(one.frame));
  }
  return placed;
}

}  // namespace stereomotion
