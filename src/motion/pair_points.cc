#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "motion/match_rigid.h"

namespace stereomotion {
namespace {

struct Meeting {
  double gates = 0;  ///< distance in units of the gate
  int a = -1, b = -1;
};

std::vector<Meeting> FindMeetings(const Rigid3& b_from_a, const PointCloud& a, const PointCloud& b,
                                  double gate_sigma) {
  std::vector<Meeting> meetings;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector3d p_in_b_mm = b_from_a * a[i].p_mm;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const double gate_mm = gate_sigma * std::hypot(a[i].sigma_mm, b[j].sigma_mm);
      const double distance2 = (p_in_b_mm - b[j].p_mm).squaredNorm();
      if (distance2 > gate_mm * gate_mm) continue;
      meetings.push_back(
          {std::sqrt(distance2) / gate_mm, static_cast<int>(i), static_cast<int>(j)});
    }
  }
  std::sort(meetings.begin(), meetings.end(), [](const Meeting& x, const Meeting& y) {
    return std::tie(x.gates, x.a, x.b) < std::tie(y.gates, y.a, y.b);
  });
  return meetings;
}

/// Marks what a taken point excludes: itself, and what shares a detection with it.
class Taken {
 public:
  explicit Taken(const PointCloud& cloud) : cloud_(cloud), points_(cloud.size(), false) {}
  [[nodiscard]] bool IsFree(int point) const {
    const auto& detections = cloud_[static_cast<std::size_t>(point)].detections;
    if (points_[static_cast<std::size_t>(point)]) return false;
    for (std::size_t side = 0; side < 2; ++side) {
      const auto& used = used_[side];
      const int detection = detections[side];
      if (detection >= 0 && std::find(used.begin(), used.end(), detection) != used.end()) {
        return false;
      }
    }
    return true;
  }
  void Take(int point) {
    points_[static_cast<std::size_t>(point)] = true;
    const auto& detections = cloud_[static_cast<std::size_t>(point)].detections;
    for (std::size_t side = 0; side < 2; ++side) used_[side].push_back(detections[side]);
  }

 private:
  const PointCloud& cloud_;
  std::vector<bool> points_;
  std::array<std::vector<int>, 2> used_;
};

std::vector<std::pair<int, int>> PairOneToOne(const Rigid3& b_from_a, const PointCloud& a,
                                              const PointCloud& b, double gate_sigma) {
  std::vector<std::pair<int, int>> pairs;
  Taken taken_a(a), taken_b(b);
  for (const Meeting& meeting : FindMeetings(b_from_a, a, b, gate_sigma)) {
    if (!taken_a.IsFree(meeting.a) || !taken_b.IsFree(meeting.b)) continue;
    taken_a.Take(meeting.a);
    taken_b.Take(meeting.b);
    pairs.emplace_back(meeting.a, meeting.b);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// Fits the motion; nothing where the points lie on a line, seen with their σ.
std::optional<Rigid3> Align(const std::vector<std::pair<int, int>>& pairs, const PointCloud& a,
                            const PointCloud& b) {
  const auto n = static_cast<Eigen::Index>(pairs.size());
  Eigen::Matrix3Xd from(3, n), to(3, n);
  double sigma_mm = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& [in_a, in_b] = pairs[static_cast<std::size_t>(i)];
    from.col(i) = a[static_cast<std::size_t>(in_a)].p_mm;
    to.col(i) = b[static_cast<std::size_t>(in_b)].p_mm;
    sigma_mm = std::max({sigma_mm, a[static_cast<std::size_t>(in_a)].sigma_mm,
                         b[static_cast<std::size_t>(in_b)].sigma_mm});
  }
  const Eigen::Matrix3Xd spread = from.colwise() - from.rowwise().mean().eval();
  constexpr double kThinnest = 0.02;  // of the length: a roll known to 1/50 of the tilt
  const Eigen::Vector3d sizes = Eigen::JacobiSVD<Eigen::Matrix3Xd>(spread).singularValues();
  constexpr double kSigmas = 10;
  if (sizes[1] < std::max(kThinnest * sizes[0], kSigmas * sigma_mm)) return std::nullopt;
  return AlignPoints(from, to);
}

}  // namespace

std::optional<RigidMatch> PairUnder(const Rigid3& b_from_a, const PointCloud& a,
                                    const PointCloud& b, double widening,
                                    const RigidMatchOptions& options) {
  RigidMatch match{b_from_a, {}};
  const auto least = static_cast<std::size_t>(options.min_points);
  for (const double gate : {widening * options.gate_sigma, options.gate_sigma}) {
    match.pairs = PairOneToOne(match.b_from_a, a, b, gate);
    if (match.pairs.size() < least) return std::nullopt;
    const auto aligned = Align(match.pairs, a, b);
    if (!aligned) return std::nullopt;
    match.b_from_a = *aligned;
  }
  return match;
}

}  // namespace stereomotion
