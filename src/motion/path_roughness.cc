#include "motion/path_roughness.h"

#include <algorithm>

#include "motion/significance.h"

namespace stereomotion {
namespace {

constexpr int kQuartic = 4, kSextic = 6;
constexpr int kNeighbourhood = 4;  // half windows to either side that are pooled
constexpr double kWidening = 1.4;  // from one pilot window to the next
/// Windows are taken every quarter of their length: neighbours share three quarters of their poses.
constexpr int kOverlap = 4;
/// Real noise may be larger than stated; beyond this it is taken for misfit.
constexpr double kLargestNoiseScale = 1.5;

std::vector<int> HalfWindows(int least, int widest) {
  std::vector<int> windows;
  for (double half = least; half < widest; half = std::max(half + 1, half * kWidening)) {
    windows.push_back(static_cast<int>(half));
  }
  windows.push_back(widest);
  return windows;
}

/// Places about `stride` apart from `first` to `last`, the same seen from both ends (a recording
/// read backwards has the same anchors).
std::vector<std::size_t> Anchors(std::size_t first, std::size_t last, std::size_t stride) {
  const std::size_t span = last - first;
  std::size_t steps = std::max<std::size_t>(1, span / stride);
  if (span % 2 == 1 && steps % 2 == 0) ++steps;  // no place in the middle of an odd span
  std::vector<std::size_t> anchors;
  for (std::size_t k = 0; k <= (span == 0 ? 0 : steps); ++k) {
    const bool early = 2 * k <= steps;
    anchors.push_back(first + (early ? k * span / steps : span - (steps - k) * span / steps));
  }
  return anchors;
}

/// Second moments of a Taylor coefficient. At another place of the neighbourhood it points another
/// way: its mean square is added in all directions, turn and place apart.
Matrix6d MomentOf(const Vector6d& coefficient) {
  Matrix6d moment = Matrix6d::Zero();
  for (const int block : {0, 3}) {
    const Eigen::Vector3d c = coefficient.segment<3>(block);
    moment.block<3, 3>(block, block) =
        c * c.transpose() + c.squaredNorm() / 3 * Eigen::Matrix3d::Identity();
  }
  return moment;
}

/// Moments of order k + 2 by those of order k, where a motion swings or circles at `rate`.
Matrix6d TwoOrdersOn(const Matrix6d& moment, int order, double rate) {
  const double ratio = rate * rate / ((order + 1) * (order + 2));
  return ratio * ratio * moment;
}

/// Foretells orders that no pilot fits: they fall as those below, k! |c_k| being geometric.
void Extrapolate(std::vector<Matrix6d>& moments) {
  for (int k = kHighestDegree + 1; k <= kHighestDegree + 2; ++k) {
    const double factorials = (k - 2.0) * (k - 3) / (k * (k - 1.0));
    for (const int block : {0, 3}) {
      const auto below = moments[k - 2].block<3, 3>(block, block);
      const double lowest = moments[k - 4].block<3, 3>(block, block).trace();
      if (lowest <= 0) continue;
      moments[k].block<3, 3>(block, block) =
          factorials * factorials * below.trace() / lowest * below;
    }
  }
}

WindowMoments Window(const PoseStretch& stretch, std::size_t at, int half) {
  WindowMoments window(stretch, stretch.times_s[at], stretch.poses[at]);
  const std::size_t last = stretch.poses.size() - 1;
  const std::size_t low = at - std::min<std::size_t>(at, half);
  const std::size_t high = std::min(last, at + half);
  window.Add(at);
  for (std::size_t i = at; i > low && window.Add(i - 1);) --i;
  for (std::size_t i = at; i < high && window.Add(i + 1);) ++i;
  return window;
}

}  // namespace

PathRoughness::PathRoughness(const PoseStretch& stretch, int widest_half_window) {
  const int widest = std::min(widest_half_window, static_cast<int>(stretch.poses.size() - 1) / 2);
  AddPilots(stretch, kQuartic, widest, quartics_);
  AddPilots(stretch, kSextic, widest, sextics_);
  if (quartics_.empty()) return;
  std::vector<double> levels;
  for (const Anchor& anchor : quartics_.front().anchors) {
    if (anchor.dof > 0) levels.push_back(anchor.chi2 / anchor.dof);
  }
  if (levels.empty()) return;
  double sum = 0;
  for (const double level : levels) sum += level;
  noise_scale_ = std::clamp(sum / static_cast<double>(levels.size()), 1.0, kLargestNoiseScale);
}

void PathRoughness::AddPilots(const PoseStretch& stretch, int degree, int widest,
                              std::vector<Pilot>& pilots) {
  const std::size_t count = stretch.poses.size();
  const int least = std::min(degree / 2 + 1, std::max(widest, 1));
  for (const int half : HalfWindows(least, std::max(widest, least))) {
    Pilot pilot{degree, half, {}};
    const std::size_t margin = std::min<std::size_t>(half, (count - 1) / 2);
    for (const std::size_t at : Anchors(margin, count - 1 - margin, std::max(1, half / 2))) {
      const WindowMoments window = Window(stretch, at, half);
      if (window.poses < 2) continue;
      const LocalPolynomial fit = FitLocalPolynomial(window, std::min(degree, window.poses - 1));
      Anchor anchor{at, {}, Chi2Of(fit, window), fit.dof};
      for (int k = 0; k <= fit.degree; ++k) {
        const Vector6d c = fit.coefficients.segment<6>(6 * k);
        anchor.moments.push_back(MomentOf(c));
      }
      // Cut short by its turn, a window does not tell the higher orders. A point of a body that
      // turns at ω circles at ω.
      const double rate = fit.degree > 0 ? fit.coefficients.segment<3>(6).norm() : 0;
      for (int k = fit.degree + 1; k <= degree; ++k) {
        anchor.moments.push_back(k < 3 ? Matrix6d::Zero().eval()
                                       : TwoOrdersOn(anchor.moments[k - 2], k - 2, rate));
      }
      pilot.anchors.push_back(std::move(anchor));
    }
    if (!pilot.anchors.empty()) pilots.push_back(std::move(pilot));
  }
}

PathRoughness::Pooled PathRoughness::PoolNear(const Pilot& pilot, std::size_t i) const {
  Pooled pooled;
  pooled.moments.assign(kHighestDegree + kBiasOrders + 1, Matrix6d::Zero());
  const auto reach = static_cast<std::size_t>(kNeighbourhood * pilot.half_window);
  double chi2 = 0;
  int dof = 0, used = 0;
  for (const Anchor& anchor : pilot.anchors) {
    if (anchor.at > i + reach || i > anchor.at + reach) continue;
    for (std::size_t k = 0; k < anchor.moments.size(); ++k) pooled.moments[k] += anchor.moments[k];
    chi2 += anchor.chi2;
    dof += anchor.dof;
    ++used;
  }
  for (Matrix6d& moment : pooled.moments) moment /= std::max(used, 1);
  // Overlapping windows repeat each other: as many independent degrees of freedom as there are.
  const double share = used > kOverlap ? 1.0 / kOverlap : 1.0 / std::max(used, 1);
  pooled.misfit = chi2 / std::max(dof, 1);
  pooled.adequate =
      used > 0 && chi2 * share <= noise_scale_ * LargestChi2(std::max(1.0, dof * share));
  return pooled;
}

int PathRoughness::Widest(const std::vector<Pilot>& pilots, std::size_t i, PathBend& bend) const {
  int reach = 0;
  for (const Pilot& pilot : pilots) {
    const Pooled pooled = PoolNear(pilot, i);
    if (reach > 0 && !pooled.adequate) break;
    if (!pooled.adequate && pilot.degree == kSextic) bend.misfit = std::max(1.0, pooled.misfit);
    reach = pilot.half_window;
    // A pilot of higher degree adds only the orders that the lower one does not tell.
    for (int k = pilot.degree == kSextic ? kQuartic + 1 : 0; k <= pilot.degree; ++k) {
      bend.moments[k] = pooled.moments[k];
    }
  }
  return reach;
}

PathBend PathRoughness::Near(std::size_t i) const {
  PathBend bend;
  bend.moments.assign(kHighestDegree + kBiasOrders + 1, Matrix6d::Zero());
  bend.quartic_reach = Widest(quartics_, i, bend);
  bend.sextic_reach = Widest(sextics_, i, bend);
  Extrapolate(bend.moments);
  return bend;
}

}  // namespace stereomotion
