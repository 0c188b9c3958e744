#include "static_places.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "detection/segment_blobs.h"

namespace stereomotion {
namespace {

StaticPlace Outlined(const std::vector<Run>& runs, const RigCamera& camera, double margin_px) {
  StaticPlace place;
  std::vector<Eigen::Vector2d> corners;
  const double u_last = camera.width_px - 1, v_last = camera.height_px - 1;
  for (const Run& run : runs) {
    place.area_px += run.u_end - run.u_begin;
    for (const double u : {run.u_begin - margin_px, run.u_end - 1 + margin_px}) {
      for (const double v : {run.v - margin_px, run.v + margin_px}) {
        corners.emplace_back(std::clamp(u, 0.0, u_last), std::clamp(v, 0.0, v_last));
      }
    }
  }
  place.outline = ConvexHull(std::move(corners));
  return place;
}

/// Keeps of a run what rises over the background as far as a search for balls asks of single
/// images, smoothed by 3×3 there: the lowest levels of many have less noise, and show more.
void KeepBright(const ImageView& image, const std::vector<float>& level_dn,
                const BackgroundMap& cells, const SensorNoise& noise, double threshold_sigma,
                const Run& run, RunList& bright) {
  constexpr double kSmoothing = 3;  // the mean of nine pixels has a third of the noise
  for (int u = run.u_begin; u < run.u_end; ++u) {
    const double background_dn = level_dn[static_cast<std::size_t>(cells.CellAt(u, run.v))];
    const double sigma_dn = std::sqrt(noise.VarianceDn2(background_dn));
    if (image.At(u, run.v) - background_dn > threshold_sigma / kSmoothing * sigma_dn) {
      bright.Append(run.v, u, u + 1);
    }
  }
}

/// Width or height of a place, whichever is larger.
int ExtentPx(const std::vector<Run>& runs) {
  Run box = runs.front();
  for (const Run& run : runs) {
    box.u_begin = std::min(box.u_begin, run.u_begin);
    box.u_end = std::max(box.u_end, run.u_end);
  }
  return std::max(box.u_end - box.u_begin, runs.back().v - runs.front().v + 1);
}

Eigen::Vector2d MiddleOf(const ImagePolygon& polygon) {
  Eigen::Vector2d sum_px = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& corner : polygon) sum_px += corner;
  return sum_px / static_cast<double>(polygon.size());
}

}  // namespace

void HighestBackground::Add(const ImageView& image, const SensorNoise& noise, double max_ball_px) {
  EstimateBackground(image, noise, max_ball_px, map_);
  if (level_dn_.size() != map_.level_dn.size()) level_dn_.assign(map_.level_dn.size(), 0);
  for (std::size_t i = 0; i < level_dn_.size(); ++i) {
    level_dn_[i] = std::max(level_dn_[i], map_.level_dn[i]);
  }
}

std::vector<StaticPlace> FindStaticPlaces(const Image& image, const HighestBackground& highest,
                                          const SensorNoise& noise, const RigCamera& camera,
                                          const DetectionOptions& detection, double margin_px) {
  BackgroundMap background;
  EstimateBackground(image.View(), noise, detection.max_diameter_px, background);
  Segmenter segmenter;
  segmenter.Segment(image.View(), background, detection.threshold_sigma);
  RunList bright;
  bright.Start(camera.height_px);
  for (const Run& run : segmenter.above_threshold().runs) {
    KeepBright(image.View(), highest.level_dn(), background, noise, detection.threshold_sigma, run,
               bright);
  }
  bright.Connect();
  std::vector<std::vector<Run>> runs_of(static_cast<std::size_t>(bright.num_labels));
  for (const Run& run : bright.runs) runs_of[static_cast<std::size_t>(run.label)].push_back(run);
  std::vector<StaticPlace> places;
  for (const std::vector<Run>& runs : runs_of) {
    constexpr int kNeighbours_px = 2;  // one on each side, from the 3×3 neighbourhoods
    if (ExtentPx(runs) > detection.max_diameter_px + kNeighbours_px) continue;
    places.push_back(Outlined(runs, camera, margin_px));
  }
  return places;
}

int CountBallPlaces(const std::vector<StaticPlace>& places, const std::vector<BallCenters>& images,
                    const RigCamera& camera) {
  const auto is_ball = [&](const StaticPlace& place) {
    ImageMask covered(camera.width_px, camera.height_px);
    MarkPolygon(place.outline, covered);
    const auto holds = [&](const Eigen::Vector2d& p_px) {
      const auto u = static_cast<int>(std::lround(p_px.x()));
      const auto v = static_cast<int>(std::lround(p_px.y()));
      return u >= 0 && v >= 0 && u < camera.width_px && v < camera.height_px &&
             covered.IsMasked(u, v);
    };
    const auto with_ball = std::count_if(images.begin(), images.end(), [&](const auto& balls_px) {
      return std::any_of(balls_px.begin(), balls_px.end(), holds);
    });
    return 2 * with_ball >= static_cast<std::ptrdiff_t>(images.size());
  };
  return static_cast<int>(std::count_if(places.begin(), places.end(), is_ball));
}

std::vector<StaticPlace> WithoutThose(std::vector<StaticPlace> all,
                                      const std::vector<StaticPlace>& masked,
                                      const RigCamera& camera) {
  ImageMask covered(camera.width_px, camera.height_px);
  for (const StaticPlace& place : masked) MarkPolygon(place.outline, covered);
  const auto is_covered = [&](const StaticPlace& place) {
    const Eigen::Vector2d middle_px = MiddleOf(place.outline);
    return covered.IsMasked(static_cast<int>(std::lround(middle_px.x())),
                            static_cast<int>(std::lround(middle_px.y())));
  };
  all.erase(std::remove_if(all.begin(), all.end(), is_covered), all.end());
  return all;
}

}  // namespace stereomotion
