#include "ball_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ball_domain.h"
#include "scaled_solver.h"
#include "secant_step.h"

namespace stereomotion {
namespace {

using F = FitParameters;
using P = BallModel;

/// The deviance is summed in single precision; whether so small a share was won cannot be told.
constexpr double kRounding = 1e-4;
constexpr double kFirstDamping = 1e-3;
constexpr double kHopelessDamping = 1e8;
/// A step of Fisher's scoring fails where the likelihood bends twice as much as expected.
constexpr double kClearlyTooLong = 1.5;

/// Takes a parameter out of the equations.
template <class M, class V>
void Freeze(int k, M& hessian, V& gradient) {
  hessian.row(k).setZero();
  hessian.col(k).setZero();
  hessian(k, k) = 1;
  gradient[k] = 0;
}

template <int N>
class Climber {
 public:
  Climber(const SensorNoise& noise, const Pulls& pulls, const BallTerms& terms,
          const SearchLimits& limits, BallPatch& patch, BallSearch& search)
      : noise_(noise),
        pulls_(pulls),
        terms_(terms),
        limits_(limits),
        patch_(patch),
        search_(search) {}

  void Climb(const F::Vector& from) {
    search_.at = from;
    search_.last_step.setZero();
    search_.converged = false;
    LinearizeBall(noise_, from, N, patch_, search_.equations, limits_.num_nodes);
    search_.cost = search_.equations.deviance + pulls_.Cost(from);
    for (int i = 0; i < limits_.max_iterations && !search_.converged; ++i) {
      if (damping_ >= kHopelessDamping) break;
      ++search_.iterations;
      Iterate();
    }
  }

 private:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  void Iterate() {
    Matrix hessian = search_.equations.hessian.template topLeftCorner<N, N>();
    Vector gradient = search_.equations.gradient.template head<N>();
    hessian.diagonal() += pulls_.weight.template head<N>();
    gradient += PullAt(search_.at);
    FreezeBounds(hessian, gradient);
    const ScaledSolver<N> solver(hessian, damping_);
    if (!solver.ok()) {
      damping_ = std::max(10 * damping_, kFirstDamping);
      return;
    }
    const Vector step = solver.Solve(gradient);
    const double gain = step.dot(gradient);
    F::Vector whole = F::Vector::Zero();
    whole.template head<N>() = damping_ == 0 ? secant_.Correct(step, gradient) : step;
    Advance(hessian, gradient, whole, gain);
  }

  [[nodiscard]] Vector PullAt(const F::Vector& at) const {
    return (pulls_.weight.cwiseProduct(pulls_.usual - at)).template head<N>();
  }

  void FreezeBounds(Matrix& hessian, Vector& gradient) const {
    const BallDomain domain = DomainAt(search_.at);
    for (int k = 0; k < P::kNumParameters; ++k) {
      const bool low = search_.at[k] <= domain.low[k] && gradient[k] < 0;
      const bool high = search_.at[k] >= domain.high[k] && gradient[k] > 0;
      if (low || high) Freeze(k, hessian, gradient);
    }
    if constexpr (N == F::kNum) {
      for (const int k : {F::kSmearU, F::kSmearV}) {
        if (!terms_.smear) Freeze(k, hessian, gradient);
      }
      for (const int k : {F::kLightU, F::kLightV}) {
        if (!terms_.light) Freeze(k, hessian, gradient);
      }
    }
  }

  /// Takes a step that should win `gain`, or learns that it was too long.
  void Advance(const Matrix& hessian, const Vector& gradient, const F::Vector& step, double gain) {
    const F::Vector to = StepInsideDomain(search_.at, step);
    const bool trusted = damping_ == 0;
    // Each step leaves about the same share of what there was to win.
    const double left = trusted ? gain * (gain < last_gain_ ? gain / last_gain_ : 1.0) : gain;
    if (trusted && left < limits_.converged && (to - search_.at - step).isZero(1e-12)) {
      search_.last_step = step;
      search_.at = to;
      search_.cost -= gain;
      search_.converged = true;
      return;
    }
    BallEquations& next = equations_;
    LinearizeBall(noise_, to, N, patch_, next, limits_.num_nodes);
    secant_.Learn((to - search_.at).template head<N>(), hessian, gradient,
                  next.gradient.template head<N>() + PullAt(to));
    const double cost = next.deviance + pulls_.Cost(to);
    if (!(cost <= search_.cost) && gain > kRounding * std::abs(search_.cost)) {
      last_gain_ = 0;
      // Too long by what the secant tells: the next step from here is shorter by that.
      const bool shorten = trusted && !shortened_ && secant_.curvature() > kClearlyTooLong;
      shortened_ = shorten;
      if (!shorten) damping_ = std::max(10 * damping_, kFirstDamping);
      return;
    }
    shortened_ = false;
    if (trusted) last_gain_ = gain;
    damping_ = damping_ > 2 * kFirstDamping ? 0.1 * damping_ : 0;
    search_.at = to;
    search_.cost = cost;
    std::swap(search_.equations, next);
  }

  const SensorNoise& noise_;
  const Pulls& pulls_;
  const BallTerms& terms_;
  const SearchLimits& limits_;
  BallPatch& patch_;
  BallSearch& search_;
  BallEquations equations_;
  double damping_ = 0;
  SecantStep<N> secant_;
  bool shortened_ = false;  ///< the last step failed and was to be shortened
  double last_gain_ = 0;    ///< of the step before, 0: none to compare with
};

template <int N>
bool Invert(const F::Matrix& hessian, const BallTerms& terms, P::Matrix& covariance) {
  Eigen::Matrix<double, N, N> active = hessian.topLeftCorner<N, N>();
  Eigen::Matrix<double, N, 1> unused = Eigen::Matrix<double, N, 1>::Zero();
  if constexpr (N == F::kNum) {
    for (int k = F::kSmearU; k < F::kNum; ++k) {
      if (!(k < F::kLightU ? terms.smear : terms.light)) Freeze(k, active, unused);
    }
  }
  const ScaledSolver<N> solver(active, 0);
  if (!solver.ok()) return false;
  const Eigen::Matrix<double, N, N> inverse = solver.Solve(Eigen::Matrix<double, N, N>::Identity());
  covariance = inverse.template topLeftCorner<P::kNumParameters, P::kNumParameters>();
  return true;
}

}  // namespace

void SearchBall(const SensorNoise& noise, const Pulls& pulls, const BallTerms& terms,
                const FitParameters::Vector& from, const SearchLimits& limits, BallPatch& patch,
                BallSearch& search) {
  if (terms.any()) {
    Climber<F::kNum>(noise, pulls, terms, limits, patch, search).Climb(from);
  } else {
    Climber<P::kNumParameters>(noise, pulls, terms, limits, patch, search).Climb(from);
  }
}

bool InvertInformation(const FitParameters::Matrix& hessian, const BallTerms& terms,
                       BallModel::Matrix& covariance) {
  return terms.any() ? Invert<F::kNum>(hessian, terms, covariance)
                     : Invert<P::kNumParameters>(hessian, terms, covariance);
}

}  // namespace stereomotion
