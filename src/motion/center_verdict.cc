#include "motion/center_verdict.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "stereomotion/core/units.h"

namespace stereomotion {
namespace {

/// Two significant digits: more would claim to know the uncertainty itself.
std::string Number(double value) {
  if (!(value > 0)) return "0";
  const int decimals = std::max(0, 1 - static_cast<int>(std::floor(std::log10(value))));
  char text[64];
  if (value >= 1e4) {
    std::snprintf(text, sizeof text, "%.2g", value);
  } else {
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
  }
  return text;
}

std::string PlusMinus(double u_mm) {
  return u_mm >= 1e3 ? "± " + Number(1e-3 * u_mm) + " m" : "± " + Number(u_mm) + " mm";
}

/// Standard uncertainties along the principal directions of the covariance, ascending; the largest
/// one's direction.
struct Principal {
  Eigen::Vector3d u_mm, longest;
};

Principal PrincipalOf(const Eigen::Matrix3d& covariance_mm2) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance_mm2);
  return {solver.eigenvalues().cwiseMax(0).cwiseSqrt(), solver.eigenvectors().col(2)};
}

/// How well one centre is known.
std::string Spread(const CenterProblem& problem, const SpinCenter& center) {
  /// Directions whose uncertainties differ by less are not told apart in words.
  constexpr double kAlike = 3;
  constexpr double kAlongAxis = 0.9;  // cosine of 26°
  const Principal principal = PrincipalOf(center.covariance_mm2);
  if (problem.one_rod) return PlusMinus(principal.u_mm[2]) + " along the rod";
  if (center.free_axis_in_body) return PlusMinus(principal.u_mm[2]) + " across the axis";
  if (principal.u_mm[2] < kAlike * principal.u_mm[1]) return PlusMinus(principal.u_mm[2]);
  const bool along = problem.main_axis_in_body &&
                     std::abs(problem.main_axis_in_body->dot(principal.longest)) > kAlongAxis;
  return PlusMinus(principal.u_mm[1]) + (along ? " across and " : " in two directions and ") +
         PlusMinus(principal.u_mm[2]) + (along ? " along the axis" : " in the third");
}

std::string Known(const CenterProblem& problem, const SpinCenter& center) {
  return "centre known to " + Spread(problem, center) +
         (center.free_axis_in_body ? " and not at all along it" : "");
}

/// What the choice of the law leaves out.
std::string LawUnknown(const CenterProblem& problem, const SpinCenterResult& result) {
  if (result.law_given || !problem.turns || !result.center) return "";
  if (!result.covariance_law_unknown_mm2) return "; if the law is not known for sure: not at all";
  SpinCenter center = *result.center;
  center.covariance_mm2 = *result.covariance_law_unknown_mm2;
  return "; if the law is not known for sure: " + Spread(problem, center);
}

std::string OtherLaws(const CenterProblem& problem, const SpinCenterResult& result) {
  std::string text;
  for (const LawFit& fit : result.laws) {
    if (fit.law == PathLaw::kFree) continue;
    text += text.empty() ? "" : "; ";
    text += std::string(LawWord(fit.law)) + ": " +
            (fit.center ? Spread(problem, *fit.center) : "not determined") +
            (fit.adequate ? "" : " (refuted)");
  }
  return "by law: " + text;
}

std::string Basis(const SpinCenterResult& result) {
  const std::string law(LawWord(result.law));
  if (result.law == PathLaw::kFree) return "path free, on the stated noise of its acceleration";
  if (result.law_given) {
    return "law " + law + " as given" +
           (result.bends_otherwise ? ", though a cubic path fits much better than any law" : "");
  }
  std::string text = "law " + law;
  if (result.evidence_open) text += " taken, though a narrower one fits as well";
  // No wider law could contradict it.
  if (result.law == PathLaw::kAccelerated) text += ", the widest of all: the centre hangs on it";
  return text;
}

std::string Outcome(const CenterProblem& problem, const SpinCenterResult& result) {
  if (problem.frames.size() < 2) return "too few poses to tell a spin centre";
  if (!problem.turns && problem.one_rod) {
    return "one rod: a turn about it is not seen, and what is seen tells no axis of rotation: no "
           "spin centre";
  }
  if (!problem.turns) {
    return "no rotation beyond the noise: all points of the body move alike, no spin centre";
  }
  if (result.center) {
    return Known(problem, *result.center) + "; " + Basis(result) + LawUnknown(problem, result);
  }
  if (result.law == PathLaw::kFree) {
    if (result.law_given) return "a free path tells no spin centre";
    if (result.evidence_open) {
      return "too few frames to tell the law of the path, so no spin centre is told; name the law "
             "(--law) if you know it";
    }
    return std::string(result.bends_otherwise
                           ? "a cubic path fits much better than any law, so no spin centre is told"
                           : "no law of the path fits, so no spin centre is told") +
           (problem.one_rod ? " (one rod tells only a centre on its own line)" : "");
  }
  return "spin centre not determined; " + Basis(result);
}

/// Measures the angle between two poses; of one rod that between its directions.
class Turn {
 public:
  explicit Turn(const CenterProblem& problem) {
    if (problem.one_rod) rod_in_body_ = RodInBody(problem);
  }
  [[nodiscard]] double Between(const ObservedFrame& a, const ObservedFrame& b) const {
    const Eigen::Quaterniond &from = a.world_from_body.rotation, &to = b.world_from_body.rotation;
    if (!rod_in_body_) return from.angularDistance(to);
    const Eigen::Vector3d u = from * *rod_in_body_, v = to * *rod_in_body_;
    return std::atan2(u.cross(v).norm(), u.dot(v));
  }

 private:
  std::optional<Eigen::Vector3d> rod_in_body_;
};

}  // namespace

double RangeOfRotation(const CenterProblem& problem) {
  constexpr int kRounds = 8;
  const std::vector<ObservedFrame>& frames = problem.poses;
  const Turn turn(problem);
  double range_rad = 0;
  std::size_t from = 0;
  for (int round = 0; round < kRounds && !frames.empty(); ++round) {
    std::size_t farthest = from;
    double largest_rad = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const double angle_rad = turn.Between(frames[from], frames[i]);
      if (angle_rad <= largest_rad) continue;
      largest_rad = angle_rad;
      farthest = i;
    }
    if (largest_rad <= range_rad) break;
    range_rad = largest_rad;
    from = farthest;
  }
  return range_rad;
}

std::string CenterVerdict(const CenterProblem& problem, const SpinCenterResult& result) {
  std::string text;
  if (problem.turns) {
    text = "range of rotation " + Number(kDegreesPerRadian * result.range_of_rotation_rad) + "°: ";
  }
  text += Outcome(problem, result);
  if (problem.turns) text += " (" + OtherLaws(problem, result) + "; ± standard uncertainty)";
  return text;
}

}  // namespace stereomotion
