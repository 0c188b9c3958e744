#include "pose/pose_hypotheses.h"

#include <algorithm>
#include <cmath>

#include "pose/body_geometry.h"

namespace stereomotion {
namespace {

/// A ball of the body and the 3D candidate that may be it.
struct Placed {
  Eigen::Vector3d p_in_body_mm;
  const StereoCandidate* candidate;
};
using PlacedRod = std::vector<Placed>;

PlacedRod PlacedBalls(const Body& body, const std::vector<StereoCandidate>& candidates,
                      const RodCandidate& rod) {
  PlacedRod placed;
  for (std::size_t ball = 0; ball < rod.candidates.size(); ++ball) {
    if (rod.candidates[ball] < 0) continue;
    placed.push_back({BallInBody(body, {rod.rod, static_cast<int>(ball)}),
                      &candidates[static_cast<std::size_t>(rod.candidates[ball])]});
  }
  return placed;
}

bool ShareDetection(const PlacedRod& a, const PlacedRod& b) {
  for (const Placed& x : a) {
    for (const Placed& y : b) {
      if (x.candidate->left == y.candidate->left || x.candidate->right == y.candidate->right) {
        return true;
      }
    }
  }
  return false;
}

double ToleranceMm(const Placed& x, const Placed& y, double distance_mm,
                   const RodOptions& options) {
  const double variance_mm2 =
      x.candidate->point.covariance_mm2.trace() + y.candidate->point.covariance_mm2.trace();
  return options.distance_tolerance * distance_mm + options.gate_sigma * std::sqrt(variance_mm2);
}

/// Do the ends of both rods stand as far from each other as in the body?
bool DistancesFit(const PlacedRod& a, const PlacedRod& b, const RodOptions& options) {
  for (const Placed* x : {&a.front(), &a.back()}) {
    for (const Placed* y : {&b.front(), &b.back()}) {
      const double found_mm =
          (x->candidate->point.p_in_world_mm - y->candidate->point.p_in_world_mm).norm();
      const double in_body_mm = (x->p_in_body_mm - y->p_in_body_mm).norm();
      // The distance between crossing rods may be small: the tolerance follows the rods' length.
      const double length_mm =
          std::max(in_body_mm, (a.front().p_in_body_mm - a.back().p_in_body_mm).norm());
      if (std::abs(found_mm - in_body_mm) > ToleranceMm(*x, *y, length_mm, options)) return false;
    }
  }
  return true;
}

PoseHypothesis Place(const PlacedRod& a, const PlacedRod& b) {
  const auto count = static_cast<Eigen::Index>(a.size() + b.size());
  Eigen::Matrix3Xd in_body_mm(3, count);
  Eigen::Matrix3Xd in_world_mm(3, count);
  Eigen::Index column = 0;
  for (const PlacedRod* rod : {&a, &b}) {
    for (const Placed& placed : *rod) {
      in_body_mm.col(column) = placed.p_in_body_mm;
      in_world_mm.col(column++) = placed.candidate->point.p_in_world_mm;
    }
  }
  PoseHypothesis hypothesis{AlignPoints(in_body_mm, in_world_mm), static_cast<int>(count), 0};
  double sum_mm2 = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    sum_mm2 += (hypothesis.world_from_body * in_body_mm.col(i) - in_world_mm.col(i)).squaredNorm();
  }
  hypothesis.rms_mm = std::sqrt(sum_mm2 / static_cast<double>(count));
  return hypothesis;
}

/// Mirrored rods have the right distances, too, but do not fit.
bool Fits(const PoseHypothesis& hypothesis, const PlacedRod& a, const PlacedRod& b,
          const RodOptions& options) {
  const double length_mm = (a.front().p_in_body_mm - a.back().p_in_body_mm).norm() +
                           (b.front().p_in_body_mm - b.back().p_in_body_mm).norm();
  return hypothesis.rms_mm <= ToleranceMm(a.front(), b.front(), length_mm, options);
}

}  // namespace

PoseHypothesis PlaceByRod(const Body& body, const std::vector<StereoCandidate>& candidates,
                          const RodCandidate& rod, const Rigid3& previous) {
  const PlacedRod placed = PlacedBalls(body, candidates, rod);
  const Placed& first = placed.front();
  const Placed& last = placed.back();
  const Eigen::Vector3d axis_in_body = (last.p_in_body_mm - first.p_in_body_mm).normalized();
  const Eigen::Vector3d axis_in_world =
      (last.candidate->point.p_in_world_mm - first.candidate->point.p_in_world_mm).normalized();
  PoseHypothesis hypothesis;
  hypothesis.num_balls = static_cast<int>(placed.size());
  hypothesis.rms_mm = std::sqrt(rod.cost);  // only compared with other rods'
  Rigid3& placement = hypothesis.world_from_body;
  placement.rotation = SmallestRotation(previous.rotation, axis_in_body, axis_in_world);
  for (const Placed& ball : placed) {
    placement.translation_mm +=
        (ball.candidate->point.p_in_world_mm - placement.rotation * ball.p_in_body_mm) /
        static_cast<double>(placed.size());
  }
  return hypothesis;
}

std::vector<PoseHypothesis> MakeHypotheses(const Body& body,
                                           const std::vector<StereoCandidate>& candidates,
                                           const std::vector<RodCandidate>& rods,
                                           const RodOptions& options, const Rigid3& previous,
                                           int max_hypotheses) {
  std::vector<PoseHypothesis> hypotheses;
  std::vector<PlacedRod> placed;
  placed.reserve(rods.size());
  for (const RodCandidate& rod : rods) placed.push_back(PlacedBalls(body, candidates, rod));
  const bool on_a_line = BodyLine(body).has_value();
  for (std::size_t i = 0; i < rods.size(); ++i) {
    if (on_a_line) hypotheses.push_back(PlaceByRod(body, candidates, rods[i], previous));
    for (std::size_t j = i + 1; j < rods.size() && !on_a_line; ++j) {
      if (rods[i].rod == rods[j].rod || !DistancesFit(placed[i], placed[j], options) ||
          ShareDetection(placed[i], placed[j])) {
        continue;
      }
      const PoseHypothesis hypothesis = Place(placed[i], placed[j]);
      if (Fits(hypothesis, placed[i], placed[j], options)) hypotheses.push_back(hypothesis);
    }
  }
  const auto better = [](const PoseHypothesis& a, const PoseHypothesis& b) {
    return a.num_balls != b.num_balls ? a.num_balls > b.num_balls : a.rms_mm < b.rms_mm;
  };
  std::stable_sort(hypotheses.begin(), hypotheses.end(), better);
  if (static_cast<int>(hypotheses.size()) > max_hypotheses) {
    hypotheses.resize(static_cast<std::size_t>(max_hypotheses));
  }
  return hypotheses;
}

}  // namespace stereomotion
