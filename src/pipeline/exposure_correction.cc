#include "exposure_correction.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "local_motion.h"
#include "pose/body_geometry.h"
#include "stereomotion/camera/sphere_projection.h"
#include "stereomotion/core/units.h"

namespace stereomotion {
namespace {

/// A shift below this share of a centre's σ changes the pose by less than anyone can tell.
constexpr double kNegligibleSigmas = 0.1;
/// A smear of over a pixel can hide an acceleration that matters.
constexpr double kEvidentSmear_px = 1;
/// Poses within so many exposures of the middle one share the parabola.
constexpr double kExposuresAround = 2.5;
constexpr std::size_t kParabola = 3;

const RigCamera& CameraOf(const MeasureSetup& setup, int camera) {
  return setup.rig
      .cameras[static_cast<std::size_t>(camera == 0 ? setup.left_camera : setup.right_camera)];
}

const BallObservation& Used(const TrackedPair& pair, const BallAssignment& used) {
  return pair
      .balls[static_cast<std::size_t>(used.camera)][static_cast<std::size_t>(used.detection)];
}

bool IsSmeared(const TrackedPair& pair) {
  return std::any_of(pair.fix->used.begin(), pair.fix->used.end(), [&](const auto& used) {
    return Used(pair, used).smear_px.norm() > kEvidentSmear_px;
  });
}

/// The poses nearest in time: those within `kExposuresAround`, and at least as many as a parabola
/// needs.
std::vector<TimedPlacement> NearestPlacements(const PairNeighbours& neighbours,
                                              const TrackedPair& pair) {
  std::vector<TimedPlacement> placements;
  for (const TrackedPair* one : neighbours) {
    if (one == nullptr || !one->mean_world_from_body) continue;
    const double time_s = SecondsBetween(pair.timestamp_ns, one->timestamp_ns);
    placements.push_back({time_s, *one->mean_world_from_body});
  }
  std::sort(placements.begin(), placements.end(), [](const auto& a, const auto& b) {
    return std::abs(a.time_s) < std::abs(b.time_s) ||
           (std::abs(a.time_s) == std::abs(b.time_s) && a.time_s < b.time_s);
  });
  const double reach_s = kExposuresAround * std::max(pair.exposure_s[0], pair.exposure_s[1]);
  while (placements.size() > kParabola && std::abs(placements.back().time_s) > reach_s) {
    placements.pop_back();
  }
  return placements;
}

/// Mean over the exposure − middle of it, of a ball's projection. Gauss–Legendre, three points:
/// exact to the fifth power of time.
std::optional<Eigen::Vector2d> MeanShift(const RigCamera& camera, const LocalMotion& motion,
                                         const Eigen::Vector3d& p_in_body_mm, double exposure_s) {
  const double node_s = std::sqrt(0.6) * exposure_s / 2;
  const auto before_px = ProjectWorldPoint(camera, motion.At(p_in_body_mm, -node_s));
  const auto middle_px = ProjectWorldPoint(camera, motion.At(p_in_body_mm, 0));
  const auto after_px = ProjectWorldPoint(camera, motion.At(p_in_body_mm, node_s));
  if (!before_px || !middle_px || !after_px) return std::nullopt;
  return Eigen::Vector2d(5.0 / 18 * (*before_px + *after_px - 2 * *middle_px));
}

/// Fills `shift_px` of the used balls; says whether one is worth correcting.
bool FindShifts(const MeasureSetup& setup, const LocalMotion& motion, TrackedPair& pair) {
  bool matters = false;
  for (std::size_t camera : {0, 1}) {
    pair.shift_px[camera].assign(pair.balls[camera].size(), Eigen::Vector2d::Zero());
  }
  for (const BallAssignment& used : pair.fix->used) {
    const auto camera = static_cast<std::size_t>(used.camera);
    const auto shift_px =
        MeanShift(CameraOf(setup, used.camera), motion, BallInBody(BodyOf(setup, pair), used.id),
                  pair.exposure_s[camera]);
    if (!shift_px) continue;
    pair.shift_px[camera][static_cast<std::size_t>(used.detection)] = *shift_px;
    const Eigen::Matrix2d& covariance_px2 = Used(pair, used).covariance_px2;
    const double sigma_px = std::sqrt(0.5 * covariance_px2.trace());
    matters = matters || shift_px->norm() > kNegligibleSigmas * sigma_px;
  }
  return matters;
}

/// Variance of (pose − T²/24 × acceleration) over that of the pose.
double NoiseGrowth(const LocalMotion& motion, const TrackedPair& pair) {
  const double exposure_s = std::max(pair.exposure_s[0], pair.exposure_s[1]);
  const double share_s2 = exposure_s * exposure_s / 24;
  const double own = 1 - share_s2 * motion.middle_weight_s_2;
  return own * own + share_s2 * share_s2 * motion.other_weights2_s_4;
}

/// Says whether the shutter is said to be open for longer than from one frame to the next.
bool IsImpossible(const PairNeighbours& neighbours, const TrackedPair& pair) {
  constexpr double kShortest = 0.9;  // of the period; times tremble
  const double exposure_s = std::max(pair.exposure_s[0], pair.exposure_s[1]);
  return std::any_of(neighbours.begin(), neighbours.end(), [&](const TrackedPair* one) {
    if (one == nullptr || one == &pair) return false;
    const double gap_s = std::abs(SecondsBetween(pair.timestamp_ns, one->timestamp_ns));
    return gap_s < kShortest * exposure_s;
  });
}

/// A camera that does not tell its exposure is taken for set like the other: correcting one image
/// alone would bend the pose. Says whether that was needed.
bool AssumeSameExposure(std::array<double, 2>& exposure_s) {
  const double known_s = std::max(exposure_s[0], exposure_s[1]);
  if (known_s <= 0 || std::min(exposure_s[0], exposure_s[1]) > 0) return false;
  exposure_s = {known_s, known_s};
  return true;
}

std::vector<BallObservation> Corrected(const TrackedPair& pair, std::size_t camera) {
  std::vector<BallObservation> balls = pair.balls[camera];
  for (std::size_t i = 0; i < balls.size(); ++i) balls[i].center_px -= pair.shift_px[camera][i];
  return balls;
}

ExposureResult EstimateAgain(const MeasureSetup& setup, const PoseOptions& options,
                             const LocalMotion& motion, TrackedPair& pair) {
  std::vector<BallAssignment> used;
  const auto pose =
      EstimatePose(CameraOf(setup, 0), CameraOf(setup, 1), BodyOf(setup, pair), Corrected(pair, 0),
                   Corrected(pair, 1), pair.fix->used,
                   BodyPlacement(BodyOf(setup, pair), pair.fix->pose), options, &used);
  if (!pose) return ExposureResult::kUnknownMotion;
  pair.fix->pose = *pose;
  pair.fix->pose.covariance *= NoiseGrowth(motion, pair);
  pair.fix->used = std::move(used);
  return ExposureResult::kCorrected;
}

}  // namespace

ExposureResult CorrectForExposure(const MeasureSetup& setup, const PoseOptions& options,
                                  const PairNeighbours& neighbours, TrackedPair& pair) {
  for (auto& shifts_px : pair.shift_px) shifts_px.clear();
  if (!pair.fix) return ExposureResult::kNegligible;
  pair.exposure_assumed = AssumeSameExposure(pair.exposure_s);
  const bool smeared = IsSmeared(pair);
  if (pair.exposure_s[0] <= 0) {
    return smeared ? ExposureResult::kUnknownTime : ExposureResult::kNegligible;
  }
  if (IsImpossible(neighbours, pair)) return ExposureResult::kImpossibleTime;
  const auto motion =
      FitLocalMotion(NearestPlacements(neighbours, pair), Centroid(BodyOf(setup, pair)));
  ExposureResult result = smeared ? ExposureResult::kUnknownMotion : ExposureResult::kNegligible;
  if (motion) {
    result = FindShifts(setup, *motion, pair) ? EstimateAgain(setup, options, *motion, pair)
                                              : ExposureResult::kNegligible;
  }
  if (result != ExposureResult::kCorrected) {
    for (auto& shifts_px : pair.shift_px) shifts_px.clear();
  }
  return result;
}

}  // namespace stereomotion
