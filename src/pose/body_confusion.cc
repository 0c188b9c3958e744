#include "stereomotion/pose/body_confusion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace stereomotion {
namespace {

/// Which balls of two rods stand for each other, in this order.
struct RodMatch {
  int first = 0, second = 0;  ///< rods
  std::vector<int> balls_of_first, balls_of_second;
  double level = 0;  ///< margin over what is needed, of these rods alone
};

/// Of rods' parts that are alike, so many are combined, the most alike first.
constexpr std::size_t kMostMatches = 500;

/// Beyond this ratio of diameters no detection fits both (`AssignDetections`).
constexpr double kLargestSizeRatio = 1.6;

bool SizesFit(const Rod& a, const Rod& b) {
  const auto [low, high] = std::minmax(a.ball_diameter_mm, b.ball_diameter_mm);
  return high < kLargestSizeRatio * low;
}

/// Lists all choices of `size` of `count` things, each in ascending order.
std::vector<std::vector<int>> Choices(int count, int size) {
  std::vector<std::vector<int>> choices;
  for (std::uint32_t bits = 0; bits < (1U << static_cast<unsigned>(count)); ++bits) {
    std::vector<int> choice;
    for (int i = 0; i < count; ++i) {
      if ((bits >> static_cast<unsigned>(i) & 1U) != 0) choice.push_back(i);
    }
    if (static_cast<int>(choice.size()) == size) choices.push_back(std::move(choice));
  }
  return choices;
}

/// Holds corresponding points of both bodies, one a column.
struct Points {
  Eigen::Matrix3Xd first_mm, second_mm;
};

Points PointsOf(const Body& first, const Body& second, const std::vector<const RodMatch*>& match) {
  Points points;
  Eigen::Index size = 0;
  for (const RodMatch* rods : match) size += static_cast<Eigen::Index>(rods->balls_of_first.size());
  points.first_mm.resize(3, size);
  points.second_mm.resize(3, size);
  Eigen::Index next = 0;
  for (const RodMatch* rods : match) {
    const Rod& a = first.rods[static_cast<std::size_t>(rods->first)];
    const Rod& b = second.rods[static_cast<std::size_t>(rods->second)];
    for (std::size_t i = 0; i < rods->balls_of_first.size(); ++i, ++next) {
      points.first_mm.col(next) =
          a.balls_in_body_mm[static_cast<std::size_t>(rods->balls_of_first[i])];
      points.second_mm.col(next) =
          b.balls_in_body_mm[static_cast<std::size_t>(rods->balls_of_second[i])];
    }
  }
  return points;
}

/// RMS distance after the best rotation and shift (Umeyama 1991, without scale).
double MarginMm(const Points& points) {
  const Eigen::Matrix4d second_from_first =
      Eigen::umeyama(points.first_mm, points.second_mm, /*with_scaling=*/false);
  const Eigen::Matrix3Xd aligned_mm =
      (second_from_first.topLeftCorner<3, 3>() * points.first_mm).colwise() +
      Eigen::Vector3d(second_from_first.topRightCorner<3, 1>());
  return std::sqrt((aligned_mm - points.second_mm).squaredNorm() /
                   static_cast<double>(points.first_mm.cols()));
}

double RmsRadiusMm(const Eigen::Matrix3Xd& points_mm) {
  const Eigen::Vector3d middle_mm = points_mm.rowwise().mean();
  return std::sqrt((points_mm.colwise() - middle_mm).squaredNorm() /
                   static_cast<double>(points_mm.cols()));
}

class ConfusionSearch {
 public:
  ConfusionSearch(const Body& first, const Body& second, const ConfusionOptions& options)
      : first_(first), second_(second), options_(options) {
    const double sigma_mm = std::hypot(LargestBallSigmaMm(first), LargestBallSigmaMm(second));
    noise_mm_ = options.rods.gate_sigma * std::hypot(options.ball_sigma_mm, sigma_mm);
  }

  std::optional<BodyConfusion> Find(int balls) {
    const auto singles = ListMatches(balls);
    if (first_.rods.size() == 1 || second_.rods.size() == 1) {
      for (const RodMatch& match : singles) Consider({&match});
      return most_alike_;
    }
    for (std::size_t i = 0; i < singles.size(); ++i) {
      for (std::size_t j = i + 1; j < singles.size(); ++j) {
        if (singles[i].first == singles[j].first || singles[i].second == singles[j].second)
          continue;
        Consider({&singles[i], &singles[j]});
      }
    }
    return most_alike_;
  }

 private:
  /// Lists how single rods may stand for each other, most alike first.
  [[nodiscard]] std::vector<RodMatch> ListMatches(int balls) const {
    std::vector<RodMatch> matches;
    for (int a = 0; a < static_cast<int>(first_.rods.size()); ++a) {
      for (int b = 0; b < static_cast<int>(second_.rods.size()); ++b) {
        AddMatches(a, b, balls, matches);
      }
    }
    std::stable_sort(matches.begin(), matches.end(),
                     [](const RodMatch& a, const RodMatch& b) { return a.level < b.level; });
    if (matches.size() > kMostMatches) matches.resize(kMostMatches);
    return matches;
  }

  void AddMatches(int a, int b, int balls, std::vector<RodMatch>& matches) const {
    const Rod& rod_a = first_.rods[static_cast<std::size_t>(a)];
    const Rod& rod_b = second_.rods[static_cast<std::size_t>(b)];
    if (!SizesFit(rod_a, rod_b)) return;
    const auto count_a = static_cast<int>(rod_a.balls_in_body_mm.size());
    const auto count_b = static_cast<int>(rod_b.balls_in_body_mm.size());
    const int size = balls > 0 ? balls : std::min(count_a, count_b);
    if (size < options_.rods.min_balls) return;
    for (const auto& of_a : Choices(count_a, size)) {
      for (const auto& of_b : Choices(count_b, size)) {
        RodMatch match{a, b, of_a, of_b};
        AddIfPossible(match, matches);
        std::reverse(match.balls_of_second.begin(), match.balls_of_second.end());
        AddIfPossible(match, matches);
      }
    }
  }

  /// Whole rods always; parts of rods only where they are alike by themselves: acquisition looks
  /// for rods first, and there are many parts.
  void AddIfPossible(RodMatch& match, std::vector<RodMatch>& matches) const {
    const Points points = PointsOf(first_, second_, {&match});
    match.level = MarginMm(points) / NeededMm(points);
    const auto is_whole = [&](const Body& body, int rod) {
      return body.rods[static_cast<std::size_t>(rod)].balls_in_body_mm.size() ==
             match.balls_of_first.size();
    };
    const bool whole = is_whole(first_, match.first) && is_whole(second_, match.second);
    if (whole || match.level < 1) matches.push_back(match);
  }

  [[nodiscard]] double NeededMm(const Points& points) const {
    return options_.rods.distance_tolerance * RmsRadiusMm(points.first_mm) + noise_mm_;
  }

  void Consider(const std::vector<const RodMatch*>& match) {
    const Points points = PointsOf(first_, second_, match);
    BodyConfusion found;
    found.margin_mm = MarginMm(points);
    found.needed_mm = NeededMm(points);
    for (const RodMatch* rods : match) found.rods.emplace_back(rods->first, rods->second);
    std::sort(found.rods.begin(), found.rods.end());
    const auto level = [](const BodyConfusion& one) { return one.margin_mm / one.needed_mm; };
    if (!most_alike_ || level(found) < level(*most_alike_)) most_alike_ = std::move(found);
  }

  const Body& first_;
  const Body& second_;
  const ConfusionOptions& options_;
  double noise_mm_ = 0;
  std::optional<BodyConfusion> most_alike_;
};

}  // namespace

std::optional<BodyConfusion> FindConfusion(const Body& first, const Body& second,
                                           const ConfusionOptions& options, int balls) {
  return ConfusionSearch(first, second, options).Find(balls);
}

}  // namespace stereomotion
