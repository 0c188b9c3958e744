#include "bench/accuracy_run.h"

#include <algorithm>
#include <cmath>

#include "bench/accuracy_bound.h"
#include "bench/accuracy_scene.h"
#include "stereomotion/simulation/sensor.h"

namespace stereomotion::bench {
namespace {

/// Root of the bound's variance per axis, mean over some of the tiles.
double MeanBound_px(const TiledScene& tiles) {
  constexpr std::size_t kPlaces = 8;
  const std::size_t stride = std::max<std::size_t>(tiles.balls.size() / kPlaces, 1);
  double sum_px2 = 0;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const BallScene& ball = tiles.balls[i * stride % tiles.balls.size()];
    sum_px2 += CenterBound(ball, StudySensor()).trace() / 2;
  }
  return std::sqrt(sum_px2 / kPlaces);
}

/// Finds what was found nearest to a place; null where nothing is within `reach_px`.
const FoundCenter* Nearest(const std::vector<FoundCenter>& found, const Eigen::Vector2d& place_px,
                           double reach_px) {
  const FoundCenter* nearest = nullptr;
  for (const FoundCenter& one : found) {
    const double distance_px = (one.center_px - place_px).norm();
    if (distance_px >= reach_px) continue;
    reach_px = distance_px;
    nearest = &one;
  }
  return nearest;
}

void Score(const TiledScene& tiles, const Condition& condition,
           const std::vector<FoundCenter>& found, MethodResult* results) {
  // What lies farther off than this is no measurement of the ball.
  const double reach_px = condition.diameter_px * (1 + condition.smear_diameters) / 2;
  for (std::size_t i = 0; i < tiles.balls.size(); ++i) {
    const Eigen::Vector2d& truth_px = tiles.balls[i].ball.center_px;
    MethodResult& result = results[condition.each_phase ? i : 0];
    const FoundCenter* nearest = Nearest(found, truth_px, reach_px);
    if (nearest == nullptr) {
      result.score.AddMissed();
      continue;
    }
    const Eigen::Vector2d error_px = nearest->center_px - truth_px;
    result.score.Add(error_px, tiles.along_units[i], *nearest);
    if (condition.keeps_errors) result.errors_px.push_back(error_px.norm());
  }
}

/// Makes an empty result for every method, or for every method and phase.
std::vector<MethodResult> EmptyResults(const std::vector<std::unique_ptr<CenterMethod>>& methods,
                                       const TiledScene& tiles, bool each_phase) {
  std::vector<MethodResult> results;
  for (const auto& method : methods) {
    for (std::size_t i = 0; i < (each_phase ? tiles.balls.size() : 1); ++i) {
      MethodResult result;
      result.method = method->name();
      const Eigen::Vector2d& center_px = tiles.balls[i].ball.center_px;
      if (each_phase) result.phase = center_px.array() - center_px.array().floor();
      results.push_back(result);
    }
  }
  return results;
}

}  // namespace

ConditionResult RunCondition(const Condition& condition, std::uint64_t seed) {
  const TiledScene tiles = RenderTiles(condition, seed);
  const auto methods = MakeMethods(condition, tiles.mean_dn.maxCoeff() - StudyBackgroundDn());
  const std::size_t parts = condition.each_phase ? tiles.balls.size() : 1;
  ConditionResult result{condition, MeanBound_px(tiles),
                         EmptyResults(methods, tiles, condition.each_phase)};
  const int per_image = condition.each_phase ? 1 : static_cast<int>(tiles.balls.size());
  SensorOptions sensor;
  sensor.noise = StudySensor();
  sensor.seed = seed;
  Image image;
  std::vector<FoundCenter> found;
  for (int done = 0; done < condition.balls; done += per_image) {
    ++sensor.stream;
    Expose(tiles.mean_dn, sensor, image);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      methods[m]->Find(image, found);
      Score(tiles, condition, found, &result.methods[m * parts]);
    }
  }
  return result;
}

}  // namespace stereomotion::bench
