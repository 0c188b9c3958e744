#include "refine_learned.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "stereomotion/motion/refine_structure.h"
#include "stereomotion/motion/time_offset.h"

namespace stereomotion {
namespace {

/// Residuals (χ² per degree of freedom) beyond which the refined body is doubtful.
constexpr double kDoubtfulChi2Dof = 2;
/// Turns of lag and geometry: each starts where the last one ended, the first far off.
constexpr int kTurns = 3;
/// Prior of the balls' places while the lag is sought: it says nothing of them, but how far a lag
/// may have bent them.
constexpr double kOpenSigma_mm = 10;

void TakeStructure(const Structure& structure, Body& body) {
  auto next = structure.balls_in_body_mm.begin();
  for (Rod& rod : body.rods) {
    for (Eigen::Vector3d& ball : rod.balls_in_body_mm) ball = *next++;
  }
  body.covariance_mm2 = structure.covariance_mm2;
  if (structure.calibration_covariance_mm2.size() > 0) {
    body.covariance_mm2 += structure.calibration_covariance_mm2;
  }
}

void WarnOfResiduals(const Structure& structure, bool rig_states_errors, const Body& body,
                     std::vector<std::string>& warnings) {
  const double level = structure.chi2 / std::max(1, structure.dof);
  if (level <= kDoubtfulChi2Dof) return;
  warnings.push_back(body.name + ": residuals are " + std::to_string(std::sqrt(level)) +
                     " times the image noise; " +
                     (rig_states_errors ? "the rig's stated errors may explain that, or"
                                        : "the rig may be wrong, or") +
                     " the body is not rigid");
}

/// Estimates the lag together with the geometry: to `EstimateTimeOffset` the balls' places are a
/// common error, wide open. Nothing where no lag stands out in the end.
std::optional<TimeOffset> EstimateLag(MotionData data) {
  const auto size = static_cast<Eigen::Index>(3 * data.balls_in_body_mm.size());
  data.structure_covariance_mm2 =
      kOpenSigma_mm * kOpenSigma_mm * Eigen::MatrixXd::Identity(size, size);
  auto lag = EstimateTimeOffset(data);
  for (int turn = 1; lag && lag->significant && turn < kTurns; ++turn) {
    const auto structure = RefineStructure(WithTimeOffset(data, lag->offset_s));
    if (!structure) return std::nullopt;
    data.balls_in_body_mm = structure->balls_in_body_mm;
    for (std::size_t f = 0; f < data.frames.size(); ++f) {
      data.frames[f].pose.world_from_body = structure->poses[f];
    }
    lag = EstimateTimeOffset(data);
  }
  if (!lag || !lag->significant) return std::nullopt;
  return lag;
}

/// Refines without the lag; what its uncertainty does to the body is added to its covariance.
bool RefineWithoutLag(const MotionData& data, const TimeOffset& lag, Body& body,
                      std::vector<std::string>& warnings) {
  const double u_s = std::hypot(lag.u_s, lag.calibration_u_s);
  const auto structure = RefineStructure(WithTimeOffset(data, lag.offset_s));
  const auto later = RefineStructure(WithTimeOffset(data, lag.offset_s + u_s));
  const auto sooner = RefineStructure(WithTimeOffset(data, lag.offset_s - u_s));
  if (!structure || !later || !sooner) return false;
  TakeStructure(*structure, body);
  Eigen::VectorXd bend_mm(body.covariance_mm2.rows());
  for (std::size_t i = 0; i < structure->balls_in_body_mm.size(); ++i) {
    bend_mm.segment<3>(static_cast<Eigen::Index>(3 * i)) =
        (later->balls_in_body_mm[i] - sooner->balls_in_body_mm[i]) / 2;
  }
  body.covariance_mm2 += bend_mm * bend_mm.transpose();
  WarnOfResiduals(*structure, data.rig.covariance.has_value(), body, warnings);
  return true;
}

}  // namespace

bool RefineBody(const MotionData& data, Body& body, std::vector<std::string>& warnings) {
  const auto structure = RefineStructure(data);
  if (!structure) return false;
  TakeStructure(*structure, body);
  WarnOfResiduals(*structure, data.rig.covariance.has_value(), body, warnings);
  return true;
}

bool RefineBodyAndLag(const MotionData& data, Body& body, std::vector<std::string>& warnings) {
  const auto lag = EstimateLag(data);
  if (!lag || !RefineWithoutLag(data, *lag, body, warnings)) {
    return RefineBody(data, body, warnings);
  }
  warnings.push_back(body.name + ": the right camera seems to be " + std::to_string(lag->offset_s) +
                     " s late by its own timestamps; the learned body is free of that, the poses "
                     "are not");
  return true;
}

}  // namespace stereomotion
