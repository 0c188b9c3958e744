#include "motion/sort_into_rods.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <tuple>

namespace stereomotion {
namespace {

constexpr std::size_t kFewest = 3, kMost = 9;  // balls a rod; FORMATS.md
/// Work bound of the search, far beyond what bodies of rods need.
constexpr int kMostSteps = 200'000;

/// Finds all balls between two that end a rod.
ThreadedLine LineBetween(const std::vector<Eigen::Vector3d>& balls_mm, int first, int last,
                         const RodSortOptions& options) {
  const Eigen::Vector3d& start_mm = balls_mm[static_cast<std::size_t>(first)];
  const Eigen::Vector3d along_mm = balls_mm[static_cast<std::size_t>(last)] - start_mm;
  const double length_mm = along_mm.norm();
  const double allowed_mm = options.straightness * length_mm + options.slack_mm;
  std::vector<std::pair<double, int>> places = {{0, first}, {length_mm, last}};
  ThreadedLine line;
  for (int i = 0; i < static_cast<int>(balls_mm.size()); ++i) {
    if (i == first || i == last) continue;
    const Eigen::Vector3d arm_mm = balls_mm[static_cast<std::size_t>(i)] - start_mm;
    const double place_mm = arm_mm.dot(along_mm) / length_mm;
    const double off_mm = arm_mm.cross(along_mm).norm() / length_mm;
    if (place_mm <= 0 || place_mm >= length_mm || off_mm > allowed_mm) continue;
    places.emplace_back(place_mm, i);
    line.bend = std::max(line.bend, off_mm / allowed_mm);
  }
  std::sort(places.begin(), places.end());
  for (const auto& place : places) line.balls.push_back(place.second);
  return line;
}

/// Adds the lines of more balls than usual again, less one ball between the ends: it may be another
/// rod's that crosses there.
void AddWithoutOne(std::size_t usual, std::vector<ThreadedLine>& lines) {
  const std::size_t count = lines.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t out = 1; lines[i].balls.size() > usual && out + 1 < lines[i].balls.size();
         ++out) {
      ThreadedLine line = lines[i];
      line.balls.erase(line.balls.begin() + static_cast<std::ptrdiff_t>(out));
      lines.push_back(std::move(line));
    }
  }
}

/// Chooses the lines that together are best.
class Chooser {
 public:
  Chooser(std::vector<ThreadedLine> lines, std::size_t balls, std::size_t usual)
      : lines_(std::move(lines)), usual_(usual), free_(balls, true), lines_of_(balls) {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      for (const int ball : lines_[i].balls) lines_of_[static_cast<std::size_t>(ball)].push_back(i);
    }
  }

  std::vector<std::size_t> Choose() {
    Descend(0);
    return best_;
  }

 private:
  /// More is better: balls in rods, fewer rods (negative), rods of the usual number, less bend.
  using Score = std::tuple<std::size_t, int, int, double>;

  void Descend(std::size_t ball) {
    if (++steps_ > kMostSteps) return;
    while (ball < free_.size() && !free_[ball]) ++ball;
    const std::size_t rest = free_.size() - ball;
    if (std::get<0>(score_) + rest < std::get<0>(best_score_)) return;
    if (ball == free_.size()) {
      if (score_ > best_score_) best_score_ = score_, best_ = chosen_;
      return;
    }
    for (const std::size_t line : lines_of_[ball]) {
      if (IsFree(lines_[line])) DescendWith(line, ball);
    }
    free_[ball] = false;  // left over
    Descend(ball + 1);
    free_[ball] = true;
  }

  void DescendWith(std::size_t line, std::size_t ball) {
    const Score before = score_;
    const ThreadedLine& taken = lines_[line];
    std::get<0>(score_) += taken.balls.size();
    std::get<1>(score_) -= 1;
    std::get<2>(score_) += taken.balls.size() == usual_ ? 1 : 0;
    std::get<3>(score_) -= taken.bend;
    chosen_.push_back(line);
    for (const int b : taken.balls) free_[static_cast<std::size_t>(b)] = false;
    Descend(ball + 1);
    for (const int b : taken.balls) free_[static_cast<std::size_t>(b)] = true;
    chosen_.pop_back();
    score_ = before;
  }

  [[nodiscard]] bool IsFree(const ThreadedLine& line) const {
    return std::all_of(line.balls.begin(), line.balls.end(),
                       [&](int ball) { return free_[static_cast<std::size_t>(ball)]; });
  }

  std::vector<ThreadedLine> lines_;
  std::size_t usual_;
  std::vector<bool> free_;
  std::vector<std::vector<std::size_t>> lines_of_;  ///< a ball
  std::vector<std::size_t> chosen_, best_;
  Score score_{0, 0, 0, 0}, best_score_{0, 0, 0, -1};
  int steps_ = 0;
};

}  // namespace

std::vector<ThreadedLine> LinesThrough(const std::vector<Eigen::Vector3d>& balls_mm,
                                       const RodSortOptions& options) {
  std::vector<ThreadedLine> lines;
  const int count = static_cast<int>(balls_mm.size());
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      ThreadedLine line = LineBetween(balls_mm, i, j, options);
      if (line.balls.size() >= kFewest && line.balls.size() <= kMost + 1) {
        lines.push_back(std::move(line));
      }
    }
  }
  return lines;
}

SortedRods SortIntoRods(const std::vector<Eigen::Vector3d>& balls_mm,
                        const RodSortOptions& options) {
  std::vector<ThreadedLine> lines = LinesThrough(balls_mm, options);
  AddWithoutOne(options.usual, lines);
  const auto is_long = [](const ThreadedLine& line) { return line.balls.size() > kMost; };
  lines.erase(std::remove_if(lines.begin(), lines.end(), is_long), lines.end());
  // The usual ones first, then long ones: a good choice is found early.
  std::stable_sort(lines.begin(), lines.end(), [&](const ThreadedLine& x, const ThreadedLine& y) {
    return std::make_tuple(x.balls.size() == options.usual, x.balls.size(), -x.bend) >
           std::make_tuple(y.balls.size() == options.usual, y.balls.size(), -y.bend);
  });
  SortedRods sorted;
  std::vector<bool> used(balls_mm.size(), false);
  for (const std::size_t line : Chooser(lines, balls_mm.size(), options.usual).Choose()) {
    sorted.rods.push_back(lines[line].balls);
    for (const int ball : lines[line].balls) used[static_cast<std::size_t>(ball)] = true;
  }
  for (int i = 0; i < static_cast<int>(balls_mm.size()); ++i) {
    if (!used[static_cast<std::size_t>(i)]) sorted.left_over.push_back(i);
  }
  return sorted;
}

}  // namespace stereomotion
