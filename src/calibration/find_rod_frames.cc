#include "find_rod_frames.h"

#include <algorithm>
#include <cmath>

#include "rod_labels.h"

namespace stereomotion {
namespace {

constexpr int kSearchedPerChosen = 10;  // frames that are looked at for each that is used

// The measured balls of one image, with and without distortion.
void TakePoints(const RigCamera& camera, const std::vector<BallObservation>& balls,
                std::vector<Eigen::Vector2d>& pixels_px, std::vector<Eigen::Vector2d>& rays,
                std::vector<int>& detections) {
  for (std::size_t i = 0; i < balls.size(); ++i) {
    if (balls[i].status != BlobStatus::kOk) continue;
    const auto ray = camera.model.Unproject(balls[i].center_px);
    if (!ray) continue;
    pixels_px.push_back(balls[i].center_px);
    rays.push_back(*ray);
    detections.push_back(static_cast<int>(i));
  }
}

std::vector<RodLabels> LabelImage(const CameraModel& model, const Body& body,
                                  const std::vector<Eigen::Vector2d>& rays) {
  std::vector<Eigen::Vector2d> straight_px;
  for (const auto& ray : rays) {
    straight_px.emplace_back(model.fx_px * ray.x() + model.cx_px,
                             model.fy_px * ray.y() + model.cy_px);
  }
  return LabelRods(straight_px, body);
}

// Spreads over a run by multiples of the golden ratio: even steps would meet a periodic motion
// always in the same places.
std::vector<std::size_t> PickFrames(std::size_t count, std::size_t most) {
  constexpr double kGolden = 0.6180339887498949;
  std::vector<std::size_t> picked(std::min(count, most));
  for (std::size_t k = 0; k < picked.size(); ++k) {
    const double turns = kGolden * static_cast<double>(k);
    const double place = (turns - std::floor(turns)) * static_cast<double>(count);
    picked[k] = count <= most ? k : std::min(count - 1, static_cast<std::size_t>(place));
  }
  std::sort(picked.begin(), picked.end());
  picked.erase(std::unique(picked.begin(), picked.end()), picked.end());
  return picked;
}

}  // namespace

std::vector<RodFrame> FindRodFrames(const Rig& rig, const Body& body,
                                    const std::vector<RefineFrame>& frames, int most_frames) {
  const auto most = static_cast<std::size_t>(most_frames) * kSearchedPerChosen;
  const int least_rods = std::min<int>(2, static_cast<int>(body.rods.size()));
  std::vector<RodFrame> found;
  for (const std::size_t f : PickFrames(frames.size(), most)) {
    RodFrame frame;
    frame.frame = static_cast<int>(f);
    std::array<std::vector<RodLabels>, 2> labels;
    for (int c = 0; c < 2; ++c) {
      TakePoints(rig.cameras[c], frames[f].balls[c], frame.pixels_px[c], frame.rays[c],
                 frame.detections[c]);
      labels[c] = LabelImage(rig.cameras[c].model, body, frame.rays[c]);
    }
    frame.matches = MatchRods(body, labels[0], labels[1], least_rods);
    if (!frame.matches.empty()) found.push_back(std::move(frame));
  }
  return found;
}

}  // namespace stereomotion
