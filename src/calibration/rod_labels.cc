#include "rod_labels.h"

#include <algorithm>
#include <cmath>

#include "stereomotion/calibration/find_collinear_balls.h"

namespace stereomotion {
namespace {

constexpr std::size_t kMostSets = 8;  // of one rod, and labellings of an image
// Balls' centres are off by this much without their σ telling: rest of the distortion, a partly
// covered edge, the outline's shift [px]. Misfits that differ by less are equal.
constexpr double kModelErrorPx = 0.1;

double ChiLike(double misfit_px) { return std::hypot(misfit_px, kModelErrorPx); }

std::vector<double> Distances(const Rod& rod) {
  std::vector<double> distances_mm;
  for (const Eigen::Vector3d& ball : rod.balls_in_body_mm) {
    distances_mm.push_back((ball - rod.balls_in_body_mm.front()).norm());
  }
  return distances_mm;
}

// Chooses a set for each rod in turn, or none.
class Chooser {
 public:
  struct Choice {
    RodLabels labels;
    int rods = 0;
    double misfit_px = 0;  ///< the worst of its rods
  };

  Chooser(const Body& body, const std::vector<Eigen::Vector2d>& points_px)
      : body_(body), taken_(points_px.size(), false) {
    for (const Rod& rod : body.rods) {
      auto& sets = sets_.emplace_back();
      if (rod.balls_in_body_mm.size() < 3) continue;
      sets = FindCollinearBalls(points_px, Distances(rod));
      sets.resize(std::min(sets.size(), kMostSets));
    }
  }

  std::vector<Choice> Choose() {
    Extend({}, 0);
    return choices_;
  }

 private:
  void Extend(const Choice& choice, std::size_t rod) {
    if (rod == body_.rods.size()) {
      if (choice.rods > 0) choices_.push_back(choice);
      return;
    }
    const std::size_t balls = body_.rods[rod].balls_in_body_mm.size();
    for (const CollinearBalls& set : sets_[rod]) {
      if (std::any_of(set.points.begin(), set.points.end(), [&](int p) { return taken_[p]; })) {
        continue;
      }
      Choice longer = choice;
      longer.labels.insert(longer.labels.end(), set.points.begin(), set.points.end());
      longer.misfit_px = std::max(longer.misfit_px, set.misfit_px);
      ++longer.rods;
      for (const int p : set.points) taken_[p] = true;
      Extend(longer, rod + 1);
      for (const int p : set.points) taken_[p] = false;
    }
    Choice without = choice;
    without.labels.insert(without.labels.end(), balls, -1);
    Extend(without, rod + 1);
  }

  const Body& body_;
  std::vector<bool> taken_;
  std::vector<std::vector<CollinearBalls>> sets_;
  std::vector<Choice> choices_;
};

}  // namespace

std::vector<BallId> ListBalls(const Body& body) {
  std::vector<BallId> balls;
  for (std::size_t r = 0; r < body.rods.size(); ++r) {
    for (std::size_t b = 0; b < body.rods[r].balls_in_body_mm.size(); ++b) {
      balls.push_back({static_cast<int>(r), static_cast<int>(b)});
    }
  }
  return balls;
}

std::vector<RodLabels> LabelRods(const std::vector<Eigen::Vector2d>& points_px, const Body& body) {
  auto choices = Chooser(body, points_px).Choose();
  std::stable_sort(choices.begin(), choices.end(), [](const auto& a, const auto& b) {
    return a.rods != b.rods ? a.rods > b.rods : a.misfit_px < b.misfit_px;
  });
  std::vector<RodLabels> labels;
  for (const auto& choice : choices) {
    // Twice as far off as the best: with three numbers or more from each rod, hardly by chance.
    const bool equal = choice.rods == choices.front().rods &&
                       ChiLike(choice.misfit_px) <= 2 * ChiLike(choices.front().misfit_px);
    if (equal && labels.size() < kMostSets) labels.push_back(choice.labels);
  }
  return labels;
}

int CommonRods(const Body& body, const RodLabels& first, const RodLabels& second) {
  int common = 0;
  std::size_t ball = 0;
  for (const Rod& rod : body.rods) {
    common += first[ball] >= 0 && second[ball] >= 0 ? 1 : 0;
    ball += rod.balls_in_body_mm.size();
  }
  return common;
}

}  // namespace stereomotion
