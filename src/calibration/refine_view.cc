#include "refine_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "line_bend.h"

namespace stereomotion {
namespace {

/// Corners of the first pass need no long edges: they only set up the second.
constexpr double kFirstAlongPx = 12;
/// Beyond, an edge adds little to the corner and its curvature is no constant any more.
constexpr double kMaxAlongPx = 24;
/// χ² per degree of freedom of a corner that is torn, smeared or half covered.
constexpr double kMaxChi2Dof = 400;

double MedianBlur(const std::vector<RefinedCorner>& corners) {
  std::vector<double> blurs_px;
  for (const RefinedCorner& corner : corners) {
    blurs_px.push_back(corner.model.values[CornerModel::kBlur]);
  }
  return Median(std::move(blurs_px));
}

VarianceLine MeasureVariance(const std::vector<RefinedCorner>& corners) {
  std::vector<LevelNoise> levels;
  for (const RefinedCorner& corner : corners) levels.push_back(corner.noise);
  return MeasureVariance(levels);
}

struct Pass {
  std::vector<CornerGuess> guesses;
  std::vector<RefinedCorner> corners;  ///< of each guess
};

Pass RefineAll(const ImageView& image, const std::vector<CornerGuess>& guesses,
               const CornerWindow& window) {
  Pass pass;
  for (const CornerGuess& guess : guesses) {
    const auto corner = RefineCorner(image, guess, window);
    if (!corner) continue;
    pass.guesses.push_back(guess);
    pass.corners.push_back(*corner);
  }
  return pass;
}

/// Puts the corners where the first pass found them, on lines as bent as it tells.
std::vector<CornerGuess> Recenter(const Pass& pass, const Target& target) {
  std::vector<Eigen::Vector2d> board_mm, pixels_px;
  for (std::size_t i = 0; i < pass.guesses.size(); ++i) {
    board_mm.emplace_back(target.points[pass.guesses[i].point].xyz_mm.head<2>());
    pixels_px.push_back(pass.corners[i].model.corner_px());
  }
  const LineBend bend(board_mm, pixels_px);
  std::vector<CornerGuess> guesses = pass.guesses;
  for (std::size_t i = 0; i < guesses.size(); ++i) {
    const CornerPredictor predictor(pass.corners[i].model);
    guesses[i].pixel_px = pixels_px[i];
    for (int edge = 0; edge < 2; ++edge) {
      guesses[i].arms_px[edge] = predictor.Arm(edge);
      guesses[i].curvature[edge] = bend.Curvature(pixels_px[i], predictor.Arm(edge));
    }
  }
  return guesses;
}

}  // namespace

BoardView RefineView(const ImageView& image, const Target& target,
                     const std::vector<CornerGuess>& guesses) {
  CornerWindow window;
  window.max_along_px = kFirstAlongPx;
  const Pass first = RefineAll(image, guesses, window);
  window.max_along_px = kMaxAlongPx;
  window.blur_px = MedianBlur(first.corners);
  window.variance = MeasureVariance(first.corners);
  const Pass second = RefineAll(image, Recenter(first, target), window);
  BoardView view;
  view.edge_blur_px = MedianBlur(second.corners);
  for (std::size_t i = 0; i < second.corners.size(); ++i) {
    const RefinedCorner& corner = second.corners[i];
    if (corner.chi2_dof > kMaxChi2Dof) continue;
    view.points.push_back({second.guesses[i].point, corner.model.corner_px(),
                           corner.covariance_px2 * MisfitInflation(corner.chi2_dof), 0});
  }
  std::sort(view.points.begin(), view.points.end(),
            [](const BoardPoint& a, const BoardPoint& b) { return a.point < b.point; });
  return view;
}

}  // namespace stereomotion
