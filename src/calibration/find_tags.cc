#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "detect_tags.h"
#include "find_patterns.h"
#include "refine_view.h"
#include "tag_family.h"

namespace stereomotion {
namespace {

/// Edges of one tag end before their middle, so that no pixel counts for two corners.
constexpr double kShareOfSide = 0.45;
/// Kalibr's boards have a black square in each gap's crossing: then corners are saddles.
CornerShape ShapeAt(const ImageView& image, const CornerGuess& guess, double step_px) {
  const auto grey_at = [&](double along0, double along1) {
    const Eigen::Vector2d at = guess.pixel_px + step_px * (along0 * guess.arms_px[0].normalized() +
                                                           along1 * guess.arms_px[1].normalized());
    const auto clamp = [](double x, int size) {
      return std::max(0, std::min(size - 1, static_cast<int>(std::lround(x))));
    };
    return image.At(clamp(at.x(), image.width_px), clamp(at.y(), image.height_px));
  };
  const double black_dn = grey_at(1, 1);
  const double white_dn = std::min(grey_at(1, -1), grey_at(-1, 1));
  return grey_at(-1, -1) < (black_dn + white_dn) / 2 ? CornerShape::kSaddle : CornerShape::kWedge;
}

CornerGuess GuessCorner(const ImageView& image, const Target& target, const Tag& tag, int corner,
                        double free_share) {
  CornerGuess guess;
  guess.point = Tag::kCorners * tag.index + corner;
  guess.pixel_px = tag.corners_px[corner];
  guess.arms_px = {tag.corners_px[(corner + 1) % Tag::kCorners] - guess.pixel_px,
                   tag.corners_px[(corner + 3) % Tag::kCorners] - guess.pixel_px};
  const double lengths_px[] = {guess.arms_px[0].norm(), guess.arms_px[1].norm()};
  const double sine = std::fabs(guess.arms_px[0].x() * guess.arms_px[1].y() -
                                guess.arms_px[0].y() * guess.arms_px[1].x()) /
                      (lengths_px[0] * lengths_px[1]);
  for (int i = 0; i < 2; ++i) {
    guess.along_px[i] = kShareOfSide * lengths_px[i];
    guess.across_px[i] = free_share * lengths_px[1 - i] * sine;
  }
  const double module_px = free_share * std::min(lengths_px[0], lengths_px[1]);
  guess.shape = ShapeAt(image, guess, module_px / 2);
  if (guess.shape == CornerShape::kSaddle) {
    const double gap = target.tag_spacing_mm / target.tag_size_mm;
    for (int i = 0; i < 2; ++i) {
      guess.along_px[i] = std::min(guess.along_px[i], 0.9 * gap * lengths_px[i]);
    }
  }
  return guess;
}

std::vector<CornerGuess> GuessCorners(const ImageView& image, const Target& target,
                                      const std::vector<Tag>& tags) {
  // Black's border is one bit wide, and so is the white that a tag needs around it.
  const double free_share = 1.0 / MakeTagFamily(target.family)->width_at_border;
  const double gap_share = target.tag_spacing_mm / target.tag_size_mm;
  std::vector<CornerGuess> guesses;
  for (const Tag& tag : tags) {
    for (int i = 0; i < Tag::kCorners; ++i) {
      guesses.push_back(GuessCorner(image, target, tag, i, std::min(free_share, gap_share)));
    }
  }
  return guesses;
}

}  // namespace

BoardView FindTags(const ImageView& image, const Target& target) {
  const DetectedTags tags = DetectBoardTags(image, target);
  BoardView view = RefineView(image, target, GuessCorners(image, target, tags.on_board));
  if (!view.points.empty()) return view;
  view.problem =
      tags.num_detected == 0
          ? fmt::format("no tag of family {} found", target.family)
          : fmt::format(
                "{} tags of family {} found, {} of them on the board (ids {} to {}, each "
                "once, on its grid), none with clear corners",
                tags.num_detected, target.family, tags.on_board.size(), target.first_id,
                target.first_id + target.rows * target.cols - 1);
  return view;
}

}  // namespace stereomotion
