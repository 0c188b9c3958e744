#include "check_rig.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "stereomotion/calibration/intersect_rays.h"
#include "stereomotion/core/median.h"

namespace stereomotion {
namespace {

constexpr int kGrid = 5;  // places along each axis of the volume

std::map<int, std::vector<Sight>> SightsByPoint(
    const std::vector<BundleObservation>& observations) {
  std::map<int, std::vector<Sight>> sights;
  for (const auto& o : observations) {
    sights[o.point].push_back({o.camera, o.pixel_px, o.covariance_px2});
  }
  return sights;
}

// Numbers 0 … count − 1 in a fixed random order. std::shuffle differs between libraries.
std::vector<int> Shuffled(int count) {
  std::mt19937 generator(1);
  std::vector<int> order(count);
  for (int i = 0; i < count; ++i) order[i] = i;
  for (int i = count - 1; i > 0; --i) {
    std::swap(order[i], order[generator() % static_cast<unsigned>(i + 1)]);
  }
  return order;
}

std::vector<int> PointsSeen(const BundleProblem& problem) {
  std::vector<int> points;
  for (const auto& o : problem.observations) points.push_back(o.point);
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

// The fit's outliers among the sights are compared, too: nothing is dropped to look better.
std::optional<std::vector<CheckPoint>> CheckFold(const FittedBundle& fit,
                                                 const std::vector<bool>& held) {
  FittedBundle part = fit;
  std::vector<BundleObservation> sights;
  part.problem.observations.clear();
  for (const auto& o : fit.problem.observations) {
    (held[o.point] ? sights : part.problem.observations).push_back(o);
  }
  auto solution = AdjustBundle(part.problem);
  if (!solution) return std::nullopt;
  part.solution = std::move(*solution);
  return CheckPoints(part, fit.problem.points, sights);
}

double MedianVariance(const BundleProblem& problem, int camera) {
  std::vector<double> variances;
  for (const auto& o : problem.observations) {
    if (o.camera == camera && o.used) variances.push_back(o.covariance_px2.trace() / 2);
  }
  return Median(variances);
}

std::vector<Sight> Look(const std::vector<RigCamera>& cameras, const std::vector<double>& variances,
                        const Eigen::Vector3d& p_in_world_mm) {
  std::vector<Sight> sights;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const auto pixel = ProjectWorldPoint(cameras[c], p_in_world_mm);
    if (!pixel || pixel->x() < 0 || pixel->y() < 0 || pixel->x() > cameras[c].width_px - 1 ||
        pixel->y() > cameras[c].height_px - 1 || !(variances[c] > 0)) {
      continue;
    }
    sights.push_back({static_cast<int>(c), *pixel, variances[c] * Eigen::Matrix2d::Identity()});
  }
  return sights;
}

double PerAxis(const Eigen::Matrix3d& covariance_mm2) {
  return std::sqrt(std::max(0.0, covariance_mm2.trace() / 3));
}

struct Box {
  Eigen::Array3d low = Eigen::Array3d::Constant(1e300);
  Eigen::Array3d high = Eigen::Array3d::Constant(-1e300);
};

Box BoxOfPoints(const BundleProblem& problem) {
  Box box;
  for (const auto& o : problem.observations) {
    if (!o.used) continue;
    const Eigen::Vector3d p =
        problem.views[o.view].world_from_target * problem.points[o.point].xyz_mm;
    box.low = box.low.min(p.array());
    box.high = box.high.max(p.array());
  }
  return box;
}

}  // namespace

std::vector<CheckPoint> CheckPoints(const FittedBundle& fit,
                                    const std::vector<BundlePoint>& surveyed,
                                    const std::vector<BundleObservation>& observations) {
  std::vector<CheckPoint> checks;
  for (const auto& [point, sights] : SightsByPoint(observations)) {
    const BundlePoint& known = surveyed[point];
    const auto found = IntersectRays(fit.solution.cameras, sights, known.ball_radius_mm);
    if (!found) continue;
    CheckPoint check;
    check.point = point;
    check.error_mm = found->p_in_world_mm - known.surveyed_mm;
    check.covariance_mm2 =
        found->covariance_mm2 + CalibrationCovariance(*found, fit.solution.rig_covariance);
    check.covariance_mm2.diagonal() += known.sigma_mm.cwiseAbs2();
    std::vector<int> cameras;
    for (const Sight& sight : sights) cameras.push_back(sight.camera);
    std::sort(cameras.begin(), cameras.end());
    check.num_cameras =
        static_cast<int>(std::unique(cameras.begin(), cameras.end()) - cameras.begin());
    if (check.num_cameras >= 2) checks.push_back(check);
  }
  return checks;
}

std::optional<CrossValidation> CrossValidate(const FittedBundle& fit, int folds) {
  const std::vector<int> points = PointsSeen(fit.problem);
  const std::vector<int> order = Shuffled(static_cast<int>(points.size()));
  CrossValidation result;
  result.folds = folds;
  double squared = 0, expected = 0;
  for (int fold = 0; fold < folds; ++fold) {
    std::vector<bool> held(fit.problem.points.size(), false);
    for (std::size_t i = fold; i < order.size(); i += folds) held[points[order[i]]] = true;
    const auto checks = CheckFold(fit, held);
    if (!checks) return std::nullopt;
    for (const CheckPoint& check : *checks) {
      squared += check.error_mm.squaredNorm();
      expected += check.covariance_mm2.trace();
      ++result.num_points;
    }
  }
  if (result.num_points == 0) return std::nullopt;
  result.rms_mm = std::sqrt(squared / result.num_points);
  result.predicted_rms_mm = std::sqrt(expected / result.num_points);
  return result;
}

std::vector<VolumeSigma> MapVolume(const FittedBundle& fit) {
  const BundleProblem& problem = fit.problem;
  std::vector<double> variances;
  for (int c = 0; c < static_cast<int>(problem.cameras.size()); ++c) {
    variances.push_back(MedianVariance(problem, c));
  }
  const Box box = BoxOfPoints(problem);
  std::vector<VolumeSigma> volume;
  for (int i = 0; i < kGrid * kGrid * kGrid; ++i) {
    const Eigen::Array3d place(i % kGrid, i / kGrid % kGrid, i / (kGrid * kGrid));
    const Eigen::Vector3d p = box.low + (box.high - box.low) * place / (kGrid - 1);
    const auto point =
        IntersectRays(fit.solution.cameras, Look(fit.solution.cameras, variances, p));
    if (!point) continue;
    volume.push_back({p, PerAxis(point->covariance_mm2),
                      PerAxis(CalibrationCovariance(*point, fit.solution.rig_covariance))});
  }
  return volume;
}

}  // namespace stereomotion
