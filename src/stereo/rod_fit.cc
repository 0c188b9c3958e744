#include "stereo/rod_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace stereomotion {
namespace {

using Vector5d = Eigen::Matrix<double, 5, 1>;
using Matrix5d = Eigen::Matrix<double, 5, 5>;

/// Holds one ball of the set.
struct Member {
  int ball;
  Eigen::Vector3d p_mm;
  double place_mm;  ///< along the rod, from the members' mean
  Eigen::Matrix3d information;
};

/// Holds the rod in space.
struct Line {
  Eigen::Vector3d center_mm;
  Eigen::Vector3d direction;  ///< unit
  [[nodiscard]] Eigen::Vector3d At(double place_mm) const {
    return center_mm + place_mm * direction;
  }
};

std::vector<Member> MakeMembers(const std::vector<StereoCandidate>& candidates,
                                const std::vector<double>& place_mm, const std::vector<int>& set,
                                const RodOptions& options) {
  std::vector<Member> members;
  double mean_mm = 0;
  for (std::size_t k = 0; k < set.size(); ++k) {
    if (set[k] < 0) continue;
    members.push_back({static_cast<int>(k), candidates[set[k]].point.p_in_world_mm, place_mm[k],
                       candidates[set[k]].point.covariance_mm2});
    mean_mm += place_mm[k];
  }
  mean_mm /= static_cast<double>(members.size());
  for (Member& member : members) {
    member.place_mm -= mean_mm;
    // A deviation of just the tolerance counts as just the gate.
    const double room_mm =
        options.distance_tolerance * std::abs(member.place_mm) / options.gate_sigma;
    member.information =
        (member.information + room_mm * room_mm * Eigen::Matrix3d::Identity()).inverse();
  }
  return members;
}

/// Starts from the members farthest apart, then Gauss–Newton on the sphere of directions.
Line FitLine(const std::vector<Member>& members) {
  Line line;
  const auto by_place = [](const Member& a, const Member& b) { return a.place_mm < b.place_mm; };
  const auto [first, last] = std::minmax_element(members.begin(), members.end(), by_place);
  line.direction = (last->p_mm - first->p_mm).normalized();
  line.center_mm =
      0.5 * (first->p_mm + last->p_mm) - 0.5 * (first->place_mm + last->place_mm) * line.direction;
  constexpr int kMaxIterations = 6;
  for (int i = 0; i < kMaxIterations; ++i) {
    Eigen::Matrix<double, 3, 2> tangent;
    tangent.col(0) = line.direction.unitOrthogonal();
    tangent.col(1) = line.direction.cross(tangent.col(0));
    Matrix5d hessian = Matrix5d::Zero();
    Vector5d gradient = Vector5d::Zero();
    for (const Member& member : members) {
      Eigen::Matrix<double, 3, 5> jacobian;
      jacobian << Eigen::Matrix3d::Identity(), member.place_mm * tangent;
      const Eigen::Matrix<double, 5, 3> weighted = jacobian.transpose() * member.information;
      hessian.noalias() += weighted * jacobian;
      gradient.noalias() += weighted * (member.p_mm - line.At(member.place_mm));
    }
    const Vector5d step = hessian.ldlt().solve(gradient);
    line.center_mm += step.head<3>();
    line.direction = (line.direction + tangent * step.tail<2>()).normalized();
    if (step.dot(gradient) < 1e-8) break;  // what is left of the cost; it only ranks
  }
  return line;
}

}  // namespace

double NormalizedSquare(const Eigen::Vector3d& deviation_mm, const Eigen::Matrix3d& covariance_mm2,
                        double extra_sigma_mm) {
  const Eigen::Matrix3d covariance =
      covariance_mm2 + extra_sigma_mm * extra_sigma_mm * Eigen::Matrix3d::Identity();
  return deviation_mm.dot(covariance.inverse() * deviation_mm);
}

std::optional<RodCandidate> FitRod(const std::vector<StereoCandidate>& candidates,
                                   const std::vector<double>& place_mm, std::vector<int> set,
                                   const RodOptions& options) {
  const double gate = kRodGateSlack * options.gate_sigma * options.gate_sigma;
  for (;;) {
    const auto members = MakeMembers(candidates, place_mm, set, options);
    if (static_cast<int>(members.size()) < options.min_balls) return std::nullopt;
    const Line line = FitLine(members);
    double worst = -1, sum = 0;
    int worst_ball = -1;
    for (const Member& member : members) {
      const Eigen::Vector3d deviation_mm = member.p_mm - line.At(member.place_mm);
      const double cost = deviation_mm.dot(member.information * deviation_mm);
      sum += cost;
      if (cost > worst) {
        worst = cost;
        worst_ball = member.ball;
      }
    }
    if (!std::isfinite(sum)) return std::nullopt;
    if (worst <= gate) {
      return RodCandidate{-1, std::move(set), static_cast<int>(members.size()), sum};
    }
    set[worst_ball] = -1;
  }
}

}  // namespace stereomotion
