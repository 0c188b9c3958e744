#include "learn_points.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <thread>

#include "learn_noise.h"
#include "ordered_pairs.h"
#include "stereomotion/stereo/match_balls.h"

namespace stereomotion {
namespace {

/// Distances between rays that are compared at least, before the rig is judged by them.
constexpr std::size_t kFewestDistances = 20;
/// Share of them that the gate must hold in any case; it is 2.5 times as wide.
constexpr double kShare = 0.95;
constexpr double kGates = 2.5;

OrderedPairs::Settings Settings(const MeasureSetup& setup, const MeasureOptions& options,
                                const RunSummary& noise, std::int64_t end) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const auto search = [&](const NoiseRecord& record, const ImageMask& mask) {
    return SearchSettings{record.noise, options.detection, mask, options.search_every};
  };
  return {options.first, end, options.threads > 0 ? options.threads : cores,
          search(noise.noise_left, setup.left_mask), search(noise.noise_right, setup.right_mask)};
}

std::vector<StereoCandidate> FindCandidates(const LearnPair& pair, const RigCamera& left,
                                            const RigCamera& right, double slack_px) {
  MatchOptions options;
  options.rig_slack_px = slack_px;
  std::vector<StereoCandidate> candidates;
  FindStereoCandidates(left, right, pair.balls[0], pair.balls[1], 0, options, candidates);
  // The covariance of what is no whole ball does not tell where the ball is.
  const auto is_rough = [&](const StereoCandidate& candidate) {
    return pair.balls[0][static_cast<std::size_t>(candidate.left)].status != BlobStatus::kOk ||
           pair.balls[1][static_cast<std::size_t>(candidate.right)].status != BlobStatus::kOk;
  };
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(), is_rough),
                   candidates.end());
  return candidates;
}

/// How far both rays pass by the point that fits them best [px, root of the sum of squares].
double MissPx(const LearnPair& pair, const RigCamera& left, const RigCamera& right,
              const StereoCandidate& candidate) {
  const auto in_left = ProjectWorldPoint(left, candidate.point.p_in_world_mm);
  const auto in_right = ProjectWorldPoint(right, candidate.point.p_in_world_mm);
  const auto& left_ball = pair.balls[0][static_cast<std::size_t>(candidate.left)];
  const auto& right_ball = pair.balls[1][static_cast<std::size_t>(candidate.right)];
  return std::hypot((*in_left - left_ball.center_px).norm(),
                    (*in_right - right_ball.center_px).norm());
}

double LearnSlack(const std::vector<LearnPair>& pairs, const RigCamera& left,
                  const RigCamera& right) {
  const MatchOptions usual;
  std::vector<double> misses_px;
  for (const LearnPair& pair : pairs) {
    std::array<std::vector<int>, 2> partners{std::vector<int>(pair.balls[0].size(), 0),
                                             std::vector<int>(pair.balls[1].size(), 0)};
    const auto candidates = FindCandidates(pair, left, right, usual.rig_slack_px);
    for (const StereoCandidate& candidate : candidates) {
      ++partners[0][static_cast<std::size_t>(candidate.left)];
      ++partners[1][static_cast<std::size_t>(candidate.right)];
    }
    for (const StereoCandidate& candidate : candidates) {
      if (partners[0][static_cast<std::size_t>(candidate.left)] != 1) continue;
      if (partners[1][static_cast<std::size_t>(candidate.right)] != 1) continue;
      misses_px.push_back(MissPx(pair, left, right, candidate));
    }
  }
  if (misses_px.size() < kFewestDistances) return usual.rig_slack_px;
  const auto at = misses_px.begin() +
                  static_cast<std::ptrdiff_t>(kShare * static_cast<double>(misses_px.size()));
  std::nth_element(misses_px.begin(), at, misses_px.end());
  return std::min(usual.rig_slack_px, *at * kGates / usual.gate_sigma);
}

/// A point's uncertainty where it is largest, the rig's error counted as if it were noise: the
/// rigid motions are compared with it.
double SigmaMm(const LearnPair& pair, const StereoCandidate& candidate, double slack_px) {
  const auto& left = pair.balls[0][static_cast<std::size_t>(candidate.left)];
  const auto& right = pair.balls[1][static_cast<std::size_t>(candidate.right)];
  constexpr int kCoordinates = 4;
  const double variance_px2 =
      (left.covariance_px2.trace() + right.covariance_px2.trace()) / kCoordinates;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(candidate.point.covariance_mm2,
                                                              Eigen::EigenvaluesOnly);
  return std::sqrt(solver.eigenvalues()[2] * (1 + slack_px * slack_px / variance_px2));
}

}  // namespace

std::optional<std::vector<LearnPair>> DetectPairs(const PairSource& source,
                                                  const MeasureSetup& setup,
                                                  const MeasureOptions& options,
                                                  const std::atomic<bool>* stop,
                                                  const std::function<void()>& each_pair) {
  const std::int64_t rest = source.size() - options.first;
  const std::int64_t end =
      options.first + (options.count < 0 ? rest : std::min(rest, options.count));
  RunSummary noise;
  LearnNoise(source, setup, options, end, noise);
  OrderedPairs ordered(source, Settings(setup, options, noise, end));
  std::vector<LearnPair> pairs;
  while (DetectedPair* pair = ordered.Next()) {
    if (stop != nullptr && stop->load()) return std::nullopt;
    pairs.push_back({pair->frames.left.index,
                     pair->frames.left.timestamp_ns,
                     {std::move(pair->left), std::move(pair->right)}});
    if (each_pair) each_pair();
  }
  return pairs;
}

LearnedPoints FindPoints(const std::vector<LearnPair>& pairs, const RigCamera& left,
                         const RigCamera& right) {
  LearnedPoints points;
  points.rig_slack_px = LearnSlack(pairs, left, right);
  for (const LearnPair& pair : pairs) {
    PointCloud cloud;
    for (const auto& candidate : FindCandidates(pair, left, right, points.rig_slack_px)) {
      cloud.push_back({candidate.point.p_in_world_mm,
                       SigmaMm(pair, candidate, points.rig_slack_px),
                       {candidate.left, candidate.right}});
    }
    points.frames.push_back(std::move(cloud));
  }
  return points;
}

}  // namespace stereomotion
