#include "stereomotion/calibration/print_target.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "tests/support/board_image.h"

namespace stereomotion {
namespace {

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(TargetShapes, TagsAreWhereTheirPointsAre) {
  const Target target = testing::TagBoard();
  int tags = 0;
  for (const PrintShape& shape : TargetShapes(target)) {
    if (!shape.black) continue;
    const Eigen::Vector3d& first = target.points[4 * tags].xyz_mm;
    EXPECT_EQ(shape.x_mm, first.x());
    EXPECT_EQ(shape.y_mm, first.y());
    EXPECT_EQ(shape.width_mm, 60);
    ++tags;
  }
  EXPECT_EQ(tags, 30);
}

TEST(TargetShapes, ChessboardHasBlackInItsFirstCorner) {
  const auto shapes = TargetShapes(testing::ChessBoard());
  EXPECT_EQ(shapes.size(), 35U);  // half of 7 × 10
  EXPECT_EQ(shapes.front().x_mm, -40);
  EXPECT_EQ(shapes.front().y_mm, -40);
}

TEST(TargetShapes, RefusesWhatCannotBePrinted) {
  EXPECT_THROW(TargetShapes(Target{}), std::invalid_argument);
  Target tags = testing::TagBoard();
  tags.family = "tag25h9";
  tags.first_id = 6;  // 30 tags: 6 to 35, and there are 35
  EXPECT_THROW(TargetShapes(tags), std::invalid_argument);
  tags.family = "tag";
  EXPECT_THROW(TargetShapes(tags), std::invalid_argument);
  Target circles = testing::CircleBoard();
  circles.ball_diameter_mm = 41;
  EXPECT_THROW(TargetShapes(circles), std::invalid_argument);
  Target chessboard = testing::ChessBoard();
  chessboard.spacing_mm = 0;
  EXPECT_THROW(TargetShapes(chessboard), std::invalid_argument);
}

TEST(TargetSvg, IsInMillimetresWithABarAndItsParameters) {
  const std::string svg = TargetSvg(testing::TagBoard());
  // 6 tags of 60 mm and 5 gaps of 18 mm, twice the margin of 15 mm.
  EXPECT_TRUE(Contains(svg, "width=\"480mm\"")) << svg.substr(0, 300);
  EXPECT_TRUE(Contains(svg, "viewBox=\"0 0 480 "));
  EXPECT_TRUE(Contains(svg, "id=\"bar_100_mm\" x=\"15\""));
  EXPECT_TRUE(Contains(svg, "width=\"100\" height=\"3\""));
  EXPECT_TRUE(Contains(svg, "Print at 100 %"));
  EXPECT_TRUE(Contains(svg, "family: tag36h11, rows: 5, cols: 6, tag_size_mm: 60"));
  EXPECT_TRUE(Contains(svg, "M0.0000 0.0000h60.0000v60.0000h-60.0000z"));
  EXPECT_TRUE(Contains(TargetSvg(testing::CircleBoard()), "r=\"10.0000\""));
  EXPECT_TRUE(Contains(TargetSvg(testing::ChessBoard()), "type: chessboard, rows: 6, cols: 9"));
}

TEST(TargetSvg, BoardMustFitOnThePage) {
  PrintPage page;
  page.width_mm = 297;
  page.height_mm = 210;
  EXPECT_THROW(TargetSvg(testing::TagBoard(), page), std::invalid_argument);
  page.width_mm = 594;
  page.height_mm = 841;
  EXPECT_TRUE(Contains(TargetSvg(testing::TagBoard(), page), "width=\"594mm\""));
}

}  // namespace
}  // namespace stereomotion
