#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "find_patterns.h"
#include "grey8.h"
#include "grid_labels.h"
#include "refine_circle.h"

namespace stereomotion {
namespace {

/// Smaller ellipses have no inside.
constexpr double kMinDiameterPx = 5;
/// A circle seen from 75° beside its normal.
constexpr double kMinAxisRatio = 0.25;
/// An outline's area may differ so much from its ellipse's, besides what a pixel's ring makes.
constexpr double kMaxAreaError = 0.12;
/// Neighbourhoods of the local threshold, as shares of the image's smaller side: circles must be
/// smaller than it, the light's changes larger.
constexpr double kNeighbourhoods[] = {0.12, 0.05, 0.3};
/// How far black or white must be from the local mean [DN of 8 bits].
constexpr double kMinContrastDn = 7;
constexpr double kStartBlurPx = 0.8;

/// Takes an outline for a circle's image if it is an ellipse.
std::optional<cv::RotatedRect> ToEllipse(const std::vector<cv::Point>& outline) {
  constexpr std::size_t kMinOutline = 10;
  if (outline.size() < kMinOutline) return {};
  const cv::RotatedRect ellipse = cv::fitEllipse(outline);
  const double small_px = std::min(ellipse.size.width, ellipse.size.height);
  const double large_px = std::max(ellipse.size.width, ellipse.size.height);
  if (!(small_px >= kMinDiameterPx) || small_px < kMinAxisRatio * large_px) return {};
  const double area_px2 = CV_PI / 4 * small_px * large_px;
  const double error_px2 = std::fabs(cv::contourArea(outline) - area_px2);
  if (error_px2 > kMaxAreaError * area_px2 + large_px) return {};
  return ellipse;
}

std::vector<cv::RotatedRect> FindEllipses(const cv::Mat& grey, bool dark, double neighbourhood) {
  const int block = 2 * static_cast<int>(neighbourhood * std::min(grey.rows, grey.cols) / 2) + 3;
  cv::Mat mask;
  cv::adaptiveThreshold(grey, mask, 255, cv::ADAPTIVE_THRESH_MEAN_C,
                        dark ? cv::THRESH_BINARY_INV : cv::THRESH_BINARY, block,
                        dark ? kMinContrastDn : -kMinContrastDn);
  std::vector<std::vector<cv::Point>> outlines;
  std::vector<cv::Vec4i> parents;
  cv::findContours(mask, outlines, parents, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
  std::vector<cv::RotatedRect> ellipses;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    const bool is_hole = parents[i][3] >= 0;  // of the other brightness
    if (is_hole) continue;
    if (const auto ellipse = ToEllipse(outlines[i])) ellipses.push_back(*ellipse);
  }
  return ellipses;
}

/// Finds the grid among the ellipses; none, or all of it in OpenCV's order.
std::vector<cv::RotatedRect> OrderGrid(const std::vector<cv::RotatedRect>& ellipses,
                                       const Target& target) {
  const cv::Size size(target.cols, target.rows);
  if (static_cast<int>(ellipses.size()) < size.area()) return {};
  std::vector<cv::Point2f> candidates, centers;
  for (const cv::RotatedRect& ellipse : ellipses) candidates.push_back(ellipse.center);
  const int shape = target.asymmetric ? cv::CALIB_CB_ASYMMETRIC_GRID : cv::CALIB_CB_SYMMETRIC_GRID;
  if (!cv::findCirclesGrid(candidates, size, centers, shape, nullptr) &&
      !cv::findCirclesGrid(candidates, size, centers, shape | cv::CALIB_CB_CLUSTERING, nullptr)) {
    return {};
  }
  std::vector<cv::RotatedRect> ordered;
  for (const cv::Point2f& center : centers) {
    ordered.push_back(
        *std::min_element(ellipses.begin(), ellipses.end(), [&](const auto& a, const auto& b) {
          return cv::norm(a.center - center) < cv::norm(b.center - center);
        }));
  }
  return ordered;
}

struct FoundGrid {
  bool dark = true;
  std::vector<cv::RotatedRect> ellipses;
};

std::optional<FoundGrid> FindGrid(const cv::Mat& grey, const Target& target) {
  for (const double neighbourhood : kNeighbourhoods) {
    for (const bool dark : {true, false}) {
      FoundGrid grid{dark, OrderGrid(FindEllipses(grey, dark, neighbourhood), target)};
      if (!grid.ellipses.empty()) return grid;
    }
  }
  return {};
}

/// Brings the ellipses into the order of the target's points.
std::vector<cv::RotatedRect> Label(const std::vector<cv::RotatedRect>& found,
                                   const Target& target) {
  std::vector<cv::Point2f> centers;
  for (const cv::RotatedRect& ellipse : found) centers.push_back(ellipse.center);
  GridLabels grid = MakeGrid(centers, target.rows, target.cols);
  if (!target.asymmetric) grid = Upright(grid, false);
  std::vector<cv::RotatedRect> labelled;
  for (const Eigen::Vector2d& pixel : grid.pixels_px) {
    const cv::Point2f center(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
    labelled.push_back(*std::find_if(found.begin(), found.end(),
                                     [&](const auto& one) { return one.center == center; }));
  }
  return labelled;
}

CircleGuess ToGuess(const cv::RotatedRect& ellipse, bool dark) {
  CircleGuess guess;
  guess.dark = dark;
  guess.center_px = {ellipse.center.x, ellipse.center.y};
  guess.semi_axes_px = {ellipse.size.width / 2, ellipse.size.height / 2};
  guess.angle_rad = ellipse.angle * CV_PI / 180;
  return guess;
}

/// Distance to the nearest neighbour, for each circle.
void MeasureSpace(std::vector<CircleGuess>& guesses) {
  for (CircleGuess& guess : guesses) {
    guess.spacing_px = std::numeric_limits<double>::infinity();
    for (const CircleGuess& other : guesses) {
      if (&other == &guess) continue;
      guess.spacing_px = std::min(guess.spacing_px, (other.center_px - guess.center_px).norm());
    }
  }
}

/// Fits all circles; nothing for those that are no clear circle.
std::vector<std::optional<RefinedCircle>> RefineAll(const ImageView& image,
                                                    const std::vector<CircleGuess>& guesses,
                                                    double blur_px, const VarianceLine& variance) {
  std::vector<std::optional<RefinedCircle>> circles;
  circles.reserve(guesses.size());
  for (const CircleGuess& guess : guesses) {
    circles.push_back(RefineCircle(image, guess, blur_px, variance));
  }
  return circles;
}

double MedianBlur(const std::vector<std::optional<RefinedCircle>>& circles) {
  std::vector<double> blurs_px;
  for (const auto& circle : circles) {
    if (circle) blurs_px.push_back(circle->model.values[EllipseModel::kBlur]);
  }
  return Median(std::move(blurs_px));
}

VarianceLine MeasureNoise(const std::vector<std::optional<RefinedCircle>>& circles) {
  std::vector<LevelNoise> levels;
  for (const auto& circle : circles) {
    if (circle) levels.push_back(circle->noise);
  }
  return MeasureVariance(levels);
}

}  // namespace

BoardView FindCircles(const ImageView& image, const Target& target) {
  const auto grid = FindGrid(Grey8(image), target);
  if (!grid) {
    return {{},
            0,
            fmt::format("no grid of {} × {} circles found, or not all of it", target.rows,
                        target.cols)};
  }
  std::vector<CircleGuess> guesses;
  for (const cv::RotatedRect& ellipse : Label(grid->ellipses, target)) {
    guesses.push_back(ToGuess(ellipse, grid->dark));
  }
  MeasureSpace(guesses);
  const auto first = RefineAll(image, guesses, kStartBlurPx, {});
  const auto second = RefineAll(image, guesses, MedianBlur(first), MeasureNoise(first));
  BoardView view;
  view.edge_blur_px = MedianBlur(second);
  for (std::size_t i = 0; i < second.size(); ++i) {
    if (!second[i]) continue;
    view.points.push_back({static_cast<int>(i), second[i]->model.center_px(),
                           second[i]->covariance_px2 * MisfitInflation(second[i]->chi2_dof),
                           second[i]->model.DiameterPx()});
  }
  if (view.points.empty()) view.problem = "a grid of circles was found, but none of them is clear";
  return view;
}

}  // namespace stereomotion
