#include "gauss_legendre.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "normal_distribution.h"

namespace stereomotion {
namespace {

/// Rules of 1 … kMost nodes, computed once by Newton's method on the Legendre polynomials.
constexpr int kMost = 96;

struct Rule {
  std::vector<double> place, weight;
};

Rule MakeRule(int n) {
  Rule rule;
  for (int k = 0; k < n; ++k) {
    double x = std::cos(kPi * (k + 0.75) / (n + 0.5));
    double derivative = 1;
    for (int iteration = 0; iteration < 20; ++iteration) {
      double before = 1;
      double here = x;
      for (int j = 2; j <= n; ++j) {
        const double next = ((2 * j - 1) * x * here - (j - 1) * before) / j;
        before = here;
        here = next;
      }
      derivative = n * (x * here - before) / (x * x - 1);
      const double step = here / derivative;
      x -= step;
      if (std::abs(step) < 1e-15) break;
    }
    rule.place.push_back(x);
    rule.weight.push_back(2 / ((1 - x * x) * derivative * derivative));
  }
  return rule;
}

const std::array<Rule, kMost + 1>& Rules() {
  static const std::array<Rule, kMost + 1> rules = [] {
    std::array<Rule, kMost + 1> made;
    for (int n = 1; n <= kMost; ++n) made[static_cast<std::size_t>(n)] = MakeRule(n);
    return made;
  }();
  return rules;
}

}  // namespace

int CountNodes(double length_blurs, double nodes_per_blur) {
  constexpr double kFewest = 4;
  if (!(length_blurs > 0)) return 1;
  return static_cast<int>(
      std::min(kFewest + std::ceil(nodes_per_blur * length_blurs), 1.0 * kMost));
}

QuadratureNodes GaussLegendre(int count) {
  const Rule& rule = Rules()[static_cast<std::size_t>(std::clamp(count, 1, kMost))];
  return {static_cast<int>(rule.place.size()), rule.place.data(), rule.weight.data()};
}

}  // namespace stereomotion
