#include "rod_hypotheses.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "relative_orientation.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

constexpr std::size_t kMostTrials = 512;
constexpr std::size_t kSeedFrames = 3;
constexpr int kAllSamples = 1000;
// Of a combination that is tried all pairs are right, or it is the wrong one: a few samples do.
constexpr int kTrialSamples = 40;
// Mean of the frames' RMS distances [px] that no wrong combination reaches over several frames.
constexpr double kAgreesPx = 0.5;
// A frame's RMS distance from the epipolar lines [px]: beyond it, the frame is matched wrongly. An
// orientation from five noisy points is off by a pixel or so, a wrong ball by tens.
constexpr double kFarPx = 5;

double EpipolarRmsPx(const Eigen::Matrix3d& essential, double focal_px, const RodFrame& frame,
                     const RodMatch& match) {
  double sum = 0;
  for (const auto& [i, j] : match.points) {
    const Eigen::Vector3d a = frame.rays[0][i].homogeneous(), b = frame.rays[1][j].homogeneous();
    const Eigen::Vector3d line_b = essential * a, line_a = essential.transpose() * b;
    const double scale2 = line_a.head<2>().squaredNorm() + line_b.head<2>().squaredNorm();
    const double off = b.dot(line_b);
    sum += off * off / std::max(scale2, 1e-300);  // Sampson's distance
  }
  return focal_px * std::sqrt(sum / static_cast<double>(match.points.size()));
}

struct Choice {
  std::vector<int> match;
  double cost = 0;
};

Choice Choose(const Rigid3& second_from_first, double focal_px,
              const std::vector<RodFrame>& frames) {
  const Eigen::Matrix3d essential =
      Hat(second_from_first.translation_mm) * second_from_first.rotation.toRotationMatrix();
  Choice choice;
  for (const RodFrame& frame : frames) {
    int best = -1;
    double least_px = kFarPx;
    for (std::size_t m = 0; m < frame.matches.size(); ++m) {
      const double rms_px = EpipolarRmsPx(essential, focal_px, frame, frame.matches[m]);
      if (rms_px >= least_px) continue;
      least_px = rms_px;
      best = static_cast<int>(m);
    }
    choice.match.push_back(best);
    choice.cost += least_px;
  }
  return choice;
}

std::vector<PixelPair> PairsOf(const std::vector<RodFrame>& frames, const std::vector<int>& match) {
  std::vector<PixelPair> pairs;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    if (match[f] < 0) continue;
    for (const auto& [i, j] : frames[f].matches[match[f]].points) {
      pairs.push_back({frames[f].pixels_px[0][i], frames[f].pixels_px[1][j]});
    }
  }
  return pairs;
}

// Lists what is tried as matches: that of every frame that has but one, or every combination of the
// frames with the fewest.
std::vector<std::vector<int>> ListTrials(const std::vector<RodFrame>& frames) {
  std::vector<int> sure;
  for (const RodFrame& frame : frames) sure.push_back(frame.matches.size() == 1 ? 0 : -1);
  const auto num_sure = static_cast<std::size_t>(std::count(sure.begin(), sure.end(), 0));
  if (num_sure >= std::min(kSeedFrames, frames.size())) return {sure};
  std::vector<std::size_t> order(frames.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return frames[a].matches.size() < frames[b].matches.size();
  });
  order.resize(std::min(order.size(), kSeedFrames));
  std::vector<std::vector<int>> trials = {std::vector<int>(frames.size(), -1)};
  for (const std::size_t f : order) {
    const auto before = trials;
    if (before.size() * frames[f].matches.size() > kMostTrials) break;
    trials.clear();
    for (const auto& trial : before) {
      for (std::size_t m = 0; m < frames[f].matches.size(); ++m) {
        trials.push_back(trial);
        trials.back()[f] = static_cast<int>(m);
      }
    }
  }
  return trials;
}

}  // namespace

std::vector<RodMatch> MatchRods(const Body& body, const std::vector<RodLabels>& first,
                                const std::vector<RodLabels>& second, int least_rods) {
  int most = least_rods;
  for (const auto& a : first) {
    for (const auto& b : second) most = std::max(most, CommonRods(body, a, b));
  }
  std::map<std::vector<std::array<int, 2>>, std::vector<std::vector<int>>> matches;
  for (const auto& a : first) {
    for (const auto& b : second) {
      if (CommonRods(body, a, b) < most) continue;
      std::vector<std::pair<std::array<int, 2>, int>> pairs;
      for (std::size_t ball = 0; ball < a.size(); ++ball) {
        if (a[ball] >= 0 && b[ball] >= 0) {
          pairs.push_back({{a[ball], b[ball]}, static_cast<int>(ball)});
        }
      }
      std::sort(pairs.begin(), pairs.end());
      std::vector<std::array<int, 2>> points;
      std::vector<int> balls;
      for (const auto& [point, ball] : pairs) {
        points.push_back(point);
        balls.push_back(ball);
      }
      matches[points].push_back(balls);
    }
  }
  std::vector<RodMatch> list;
  for (auto& [points, labellings] : matches) list.push_back({points, labellings});
  return list;
}

std::optional<ResolvedFrames> ResolveFrames(const CameraModel& first, const CameraModel& second,
                                            const std::vector<RodFrame>& frames) {
  std::optional<ResolvedFrames> best;
  double least = 0;
  const auto trials = ListTrials(frames);
  const int samples = trials.size() == 1 ? kAllSamples : kTrialSamples;
  for (const auto& trial : trials) {
    const auto start = FindRelativeOrientation(first, second, PairsOf(frames, trial), samples);
    if (!start) continue;
    Choice choice = Choose(*start, first.fx_px, frames);
    if (best && choice.cost >= least) continue;
    least = choice.cost;
    best = ResolvedFrames{*start, std::move(choice.match)};
    if (least < kAgreesPx * static_cast<double>(frames.size())) break;
  }
  if (!best) return best;
  // Once more from all frames: a wide base instead of three frames.
  const auto all = FindRelativeOrientation(first, second, PairsOf(frames, best->match));
  if (!all) return std::nullopt;
  return ResolvedFrames{*all, Choose(*all, first.fx_px, frames).match};
}

}  // namespace stereomotion
