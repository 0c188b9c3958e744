#include "stereomotion/calibration/find_board.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "tests/support/board_image.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::BoardImageOptions;
using testing::OutlineCenters;
using testing::ProjectPoints;
using testing::RenderBoard;
using testing::RenderShapes;

CameraModel Camera() { return {800, 800, 319.3, 239.6}; }

/// A board in the middle, 900 mm away, turned by about 20° each way.
Rigid3 Pose(const Target& target, double roll_rad = 0.1) {
  return testing::PlaceBoard(target, {0.35, -0.3, roll_rad}, {5, -3, 900});
}

double WorstErrorPx(const BoardView& view, const std::vector<Eigen::Vector2d>& truth_px) {
  double worst_px = 0;
  for (const BoardPoint& point : view.points) {
    worst_px = std::max(worst_px, (point.pixel_px - truth_px[point.point]).norm());
  }
  return worst_px;
}

Target AsymmetricBoard() {
  Target target;
  target.type = TargetType::kCircleGrid;
  target.rows = 11;
  target.cols = 4;
  target.asymmetric = true;
  target.spacing_mm = 35;
  target.ball_diameter_mm = 26;
  target.points = MakeBoardPoints(target);
  return target;
}

/// Rounding to whole grey values, which is the same all along an edge that follows the pixel grid:
/// up to 0.5 DN on a slope of 100 DN/px on both sides of it, and the corner is extrapolated by
/// twice that.
constexpr double kRoundingPx = 0.02;

TEST(FindBoard, TagCornersWithoutNoise) {
  const Target target = testing::TagBoard();
  const Image image = RenderBoard(target, Camera(), Pose(target));
  const BoardView view = FindBoard(image.View(), target);
  EXPECT_EQ(view.points.size(), target.points.size()) << view.problem;
  EXPECT_LT(WorstErrorPx(view, ProjectPoints(target, Camera(), Pose(target))), kRoundingPx);
  // Optics of 0.6 px and the pixel's square.
  EXPECT_NEAR(view.edge_blur_px, std::sqrt(0.36 + 1 / 12.0), 0.01);
}

TEST(FindBoard, ChessboardCornersWithoutNoise) {
  const Target target = testing::ChessBoard();
  const Image image = RenderBoard(target, Camera(), Pose(target));
  const BoardView view = FindBoard(image.View(), target);
  EXPECT_EQ(view.points.size(), target.points.size()) << view.problem;
  EXPECT_LT(WorstErrorPx(view, ProjectPoints(target, Camera(), Pose(target))), kRoundingPx);
}

TEST(FindBoard, ChessboardIsCountedFromItsBlackEndHoweverItIsTurned) {
  const Target target = testing::ChessBoard();
  for (const double roll_rad : {-2.9, -1.5, -0.7, 0.0, 0.8, 1.6, 2.4, 3.1}) {
    const Image image = RenderBoard(target, Camera(), Pose(target, roll_rad));
    const BoardView view = FindBoard(image.View(), target);
    ASSERT_EQ(view.points.size(), target.points.size()) << roll_rad;
    EXPECT_LT(WorstErrorPx(view, ProjectPoints(target, Camera(), Pose(target, roll_rad))),
              kRoundingPx)
        << roll_rad;
  }
}

TEST(FindBoard, CirclesBlackOnWhiteAndWhiteOnBlack) {
  const Target target = testing::CircleBoard();
  for (const bool inverted : {false, true}) {
    BoardImageOptions options;
    options.inverted = inverted;
    const Image image = RenderBoard(target, Camera(), Pose(target), options);
    const BoardView view = FindBoard(image.View(), target);
    EXPECT_EQ(view.points.size(), target.points.size()) << view.problem;
    EXPECT_LT(WorstErrorPx(view, OutlineCenters(target, Camera(), Pose(target))), kRoundingPx);
    // The board is 900 mm away, some of it 15 % nearer or farther, and seen slantwise (cos ≥ 0.85).
    for (const BoardPoint& point : view.points) {
      EXPECT_NEAR(point.diameter_px, 20 * 800 / 900.0, 0.25 * 20 * 800 / 900.0);
    }
  }
}

TEST(FindBoard, AsymmetricCircles) {
  const Target target = AsymmetricBoard();
  for (const double roll_rad : {0.1, 1.5, 3.0}) {
    const Image image = RenderBoard(target, Camera(), Pose(target, roll_rad));
    const BoardView view = FindBoard(image.View(), target);
    EXPECT_EQ(view.points.size(), target.points.size()) << roll_rad << view.problem;
    EXPECT_LT(WorstErrorPx(view, OutlineCenters(target, Camera(), Pose(target, roll_rad))),
              kRoundingPx);
  }
}

TEST(FindBoard, TagsPrintedUpsideDown) {
  // OpenCV's dictionaries: every tag turned in its place.
  const Target target = testing::TagBoard();
  std::vector<PrintShape> shapes;
  const double step_mm = target.tag_size_mm + target.tag_spacing_mm;
  for (PrintShape shape : TargetShapes(target)) {
    const double x0 = std::floor((shape.x_mm + 1e-6) / step_mm) * step_mm;
    const double y0 = std::floor((shape.y_mm + 1e-6) / step_mm) * step_mm;
    shape.x_mm = 2 * x0 + target.tag_size_mm - shape.x_mm - shape.width_mm;
    shape.y_mm = 2 * y0 + target.tag_size_mm - shape.y_mm - shape.height_mm;
    shapes.push_back(shape);
  }
  const Image image = RenderShapes(shapes, Camera(), Pose(target));
  const BoardView view = FindBoard(image.View(), target);
  EXPECT_EQ(view.points.size(), target.points.size());
  EXPECT_LT(WorstErrorPx(view, ProjectPoints(target, Camera(), Pose(target))), kRoundingPx);
}

TEST(FindBoard, KalibrsSquaresBetweenTagsMakeSaddles) {
  const Target target = testing::TagBoard();
  std::vector<PrintShape> shapes = TargetShapes(target);
  const double step_mm = target.tag_size_mm + target.tag_spacing_mm;
  for (int row = 0; row <= target.rows; ++row) {
    for (int col = 0; col <= target.cols; ++col) {
      shapes.push_back({false, true, col * step_mm - target.tag_spacing_mm,
                        row * step_mm - target.tag_spacing_mm, target.tag_spacing_mm,
                        target.tag_spacing_mm});
    }
  }
  const Image image = RenderShapes(shapes, Camera(), Pose(target));
  const BoardView view = FindBoard(image.View(), target);
  EXPECT_GT(view.points.size(), target.points.size() * 95 / 100);
  EXPECT_LT(WorstErrorPx(view, ProjectPoints(target, Camera(), Pose(target))), 2 * kRoundingPx);
}

TEST(FindBoard, DoubledAndForeignTagsAreLeftOut) {
  const Target target = testing::TagBoard();
  std::vector<PrintShape> shapes = TargetShapes(target);
  Target second = target;  // tags 29 and 30: one is on the board already, one is not
  second.rows = 1;
  second.cols = 2;
  second.first_id = 29;
  for (PrintShape shape : TargetShapes(second)) {
    shape.y_mm += target.rows * (target.tag_size_mm + target.tag_spacing_mm);
    shapes.push_back(shape);
  }
  BoardImageOptions options;
  options.height_px = 600;
  const Image image = RenderShapes(shapes, Camera(), Pose(target), options);
  const BoardView view = FindBoard(image.View(), target);
  EXPECT_EQ(view.points.size(), target.points.size() - 4);
  for (const BoardPoint& point : view.points) EXPECT_LT(point.point, 4 * 29);
  EXPECT_LT(WorstErrorPx(view, ProjectPoints(target, Camera(), Pose(target))), kRoundingPx);
}

TEST(FindBoard, BoardCutByTheBorderGivesWhatIsInside) {
  const Target target = testing::TagBoard();
  const Rigid3 pose = testing::PlaceBoard(target, {0.2, 0.2, 0}, {300, 0, 900});
  const Image image = RenderBoard(target, Camera(), pose);
  const BoardView view = FindBoard(image.View(), target);
  EXPECT_GT(view.points.size(), 40U);
  EXPECT_LT(view.points.size(), 110U);
  EXPECT_LT(WorstErrorPx(view, ProjectPoints(target, Camera(), pose)), 2 * kRoundingPx);
}

TEST(FindBoard, OverexposedPaperDoesNotShiftCorners) {
  for (const Target& target : {testing::TagBoard(), testing::ChessBoard()}) {
    BoardImageOptions options;
    options.white_dn = 330;
    const Image image = RenderBoard(target, Camera(), Pose(target), options);
    const BoardView view = FindBoard(image.View(), target);
    EXPECT_GT(view.points.size(), target.points.size() * 95 / 100) << view.problem;
    EXPECT_LT(WorstErrorPx(view, ProjectPoints(target, Camera(), Pose(target))), 2 * kRoundingPx);
  }
}

TEST(FindBoard, BlurIsMeasured) {
  const Target target = testing::ChessBoard();
  for (const double blur_px : {0.4, 1.0, 2.0, 3.0}) {
    BoardImageOptions options;
    options.blur_px = blur_px;
    const Image image = RenderBoard(target, Camera(), Pose(target), options);
    const BoardView view = FindBoard(image.View(), target);
    EXPECT_NEAR(view.edge_blur_px, std::hypot(blur_px, std::sqrt(1 / 12.0)), 0.02 + 0.01 * blur_px);
  }
}

TEST(FindBoard, AnImageWithoutABoardSaysSo) {
  Image image;
  image.Resize(320, 240, PixelType::kGray8);
  for (int v = 0; v < 240; ++v) std::fill_n(image.Row<std::uint8_t>(v), 320, 90);
  for (const Target& target :
       {testing::TagBoard(), testing::ChessBoard(), testing::CircleBoard()}) {
    const BoardView view = FindBoard(image.View(), target);
    EXPECT_TRUE(view.points.empty());
    EXPECT_FALSE(view.problem.empty());
    EXPECT_FALSE(FindBoard(ImageView{}, target).problem.empty());
  }
}

TEST(FindBoard, SixteenBitImageGivesTheSameCorners) {
  const Target target = testing::TagBoard();
  const Image image = RenderBoard(target, Camera(), Pose(target));
  Image wide;
  wide.Resize(640, 480, PixelType::kGray16);
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      wide.Row<std::uint16_t>(v)[u] =
          static_cast<std::uint16_t>(16 * image.View().Row<std::uint8_t>(v)[u]);
    }
  }
  const BoardView narrow_view = FindBoard(image.View(), target);
  const BoardView wide_view = FindBoard(wide.View(), target);
  ASSERT_EQ(narrow_view.points.size(), wide_view.points.size());
  for (std::size_t i = 0; i < wide_view.points.size(); ++i) {
    EXPECT_LT((narrow_view.points[i].pixel_px - wide_view.points[i].pixel_px).norm(), kRoundingPx);
  }
}

TEST(FindBoard, RefusesWhatIsNoBoard) {
  const Image image = RenderBoard(testing::TagBoard(), Camera(), Pose(testing::TagBoard()));
  EXPECT_THROW(FindBoard(image.View(), Target{}), std::invalid_argument);
  Target unknown = testing::TagBoard();
  unknown.family = "tagStandard41h12";
  EXPECT_THROW(FindBoard(image.View(), unknown), std::invalid_argument);
  Target short_of_points = testing::ChessBoard();
  short_of_points.points.pop_back();
  EXPECT_THROW(FindBoard(image.View(), short_of_points), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
