#include <gtest/gtest.h>

#include "frame_test_support.h"

namespace stereomotion {
namespace {

using testing::FrameFolder;
using testing::Has;

// Reads a frame of no seeds with the keys of its target.
struct TargetText {
  FrameFolder folder;
  TargetText() { folder.cam0 = "images: cam0"; }
  FrameFile Read(const std::string& keys) {
    folder.target = "  {" + keys + "}\n";
    return folder.Read();
  }
  std::string ErrorOf(const std::string& keys) {
    folder.target = "  {" + keys + "}\n";
    return folder.ErrorText();
  }
  std::string PointsError(const std::string& rows, const std::string& diameter = "16") {
    folder.Write("points.csv", "id,x_mm,y_mm,z_mm,sigma_mm\n" + rows);
    return ErrorOf("type: control_points, points: points.csv, ball_diameter_mm: " + diameter);
  }
};

// Lists eight points in depth, 300 mm wide before they are scaled.
std::string Points(double scale, const std::string& sigma = "0") {
  std::string rows;
  for (int i = 0; i < 8; ++i) {
    const double z = i % 3 == 0 ? 0 : 200;
    rows += "p" + std::to_string(i) + "," + std::to_string(scale * 100 * (i % 4)) + "," +
            std::to_string(scale * 80 * (i / 4)) + "," + std::to_string(scale * z) + "," + sigma +
            "\n";
  }
  return rows;
}

TEST(FrameTarget, UnitsOfControlPoints) {
  TargetText text;
  EXPECT_EQ(text.PointsError(Points(1, "0.2")), "no error");
  EXPECT_TRUE(Has(text.PointsError(Points(1e-3)), "metres given as millimetres?"));
  EXPECT_TRUE(Has(text.PointsError(Points(1e3)), "micrometres given as millimetres?"));
  EXPECT_TRUE(Has(text.PointsError(Points(1, "200")), "sigma_mm 200 on points spread over 300 mm"));
  EXPECT_TRUE(Has(text.PointsError(Points(1, "-1")), "points.csv:2: sigma_mm"));
  EXPECT_TRUE(Has(text.PointsError(Points(1), "0.016"), "metres given as millimetres?"));
  EXPECT_TRUE(Has(text.PointsError(Points(1), "90"), "points p1 and p5 only 80 mm apart"));
  EXPECT_EQ(text.PointsError(Points(1), "0"), "no error");  // flat marks
}

TEST(FrameTarget, TooFewOrFlatPoints) {
  TargetText text;
  const std::string five = "a,0,0,0,0\nb,100,0,0,0\nc,0,100,0,0\nd,0,0,100,0\ne,100,100,0,0\n";
  EXPECT_TRUE(Has(text.PointsError(five), "found 5 points, expected 6 or more"));
  EXPECT_EQ(text.PointsError(five + "f,0,100,100,0\n"), "no error");
  EXPECT_TRUE(Has(text.PointsError(five + "a,0,100,100,0\n"), "points.csv:7: id: found 'a' twice"));
  EXPECT_TRUE(Has(text.PointsError(five + "f,0,0,0,0\n"), "points a and f only 0 mm apart"));
  // A tilted plane z = x + y / 2, off it by 0.01 mm.
  const std::string flat =
      "a,0,0,0.01,0\nb,100,0,100,0\nc,0,100,50,0\nd,100,100,150,0\ne,40,0,40,0\nf,0,60,30,0\n";
  EXPECT_TRUE(Has(text.PointsError(flat), "points in one plane"));
}

TEST(FrameTarget, PointsOfAnotherShape) {
  TargetText text;
  EXPECT_TRUE(Has(text.ErrorOf("type: control_points, ball_diameter_mm: 16, points: {a: 1}"),
                  "a list of {id, xyz_mm, sigma_mm}, or a CSV file"));
  EXPECT_TRUE(Has(text.ErrorOf("type: control_points, ball_diameter_mm: 16, points: []"),
                  "found no points"));
  EXPECT_TRUE(
      Has(text.ErrorOf("type: control_point, points: []"), "did you mean 'control_points'"));
  EXPECT_TRUE(Has(text.ErrorOf("type: wand, rows: 3"), "unknown key 'rows'"));
}

TEST(FrameTarget, TagGrid) {
  TargetText text;
  const std::string keys =
      "type: apriltag_grid, rows: 5, cols: 7, tag_spacing_mm: 18, sigma_mm: 0.05, ";
  const Target target =
      text.Read(keys + "family: tag36h11, tag_size_mm: 60, first_id: 10").setup.target;
  ASSERT_EQ(target.points.size(), 140U);
  EXPECT_EQ(target.points[5].id, "11.1");
  EXPECT_EQ(target.points[5].xyz_mm, Eigen::Vector3d(138, 0, 0));
  EXPECT_EQ(target.points[5].sigma_mm, 0.05);
  EXPECT_TRUE(Has(text.ErrorOf(keys + "family: tag36h10, tag_size_mm: 60"),
                  "found 'tag36h10', expected one of tag36h11, tag25h9, tag16h5"));
  EXPECT_TRUE(Has(text.ErrorOf(keys + "family: tag36h11, tag_size_mm: 0.06"),
                  "metres? 0.06 m would be 60 mm"));
  EXPECT_TRUE(Has(text.ErrorOf(keys + "family: tag16h5, tag_size_mm: 60"),
                  "found tags up to id 34, expected ids 0 to 29"));
  EXPECT_TRUE(Has(text.ErrorOf(keys + "family: tag36h11, tag_size_mm: 0.4"), "metres?"));
}

TEST(FrameTarget, Chessboard) {
  TargetText text;
  const std::string keys = "type: chessboard, spacing_mm: 25, ";
  const Target target = text.Read(keys + "rows: 6, cols: 9").setup.target;
  EXPECT_EQ(target.points.size(), 54U);
  EXPECT_EQ(target.points[10].xyz_mm, Eigen::Vector3d(25, 25, 0));
  const std::string error = text.ErrorOf(keys + "rows: 6, cols: 8");
  EXPECT_TRUE(Has(error, "looks the same upside down")) << error;
  EXPECT_TRUE(Has(error, "6 × 9 inner corners, that is 7 × 10 squares")) << error;
  EXPECT_TRUE(Has(text.ErrorOf(keys + "rows: 2, cols: 9"), "a whole number from 3"));
  EXPECT_TRUE(Has(text.ErrorOf(keys + "rows: 6, cols: 9, sigma_mm: 20"), "micrometres?"));
}

TEST(FrameTarget, CircleGrid) {
  TargetText text;
  const std::string keys = "type: circle_grid, cols: 4, spacing_mm: 20, ";
  const Target target =
      text.Read(keys + "rows: 11, asymmetric: true, circle_diameter_mm: 25").setup.target;
  EXPECT_EQ(target.points[4].xyz_mm, Eigen::Vector3d(20, 20, 0));
  EXPECT_EQ(target.ball_diameter_mm, 25);
  EXPECT_TRUE(Has(text.ErrorOf(keys + "rows: 10, asymmetric: true"), "an odd number of rows"));
  EXPECT_TRUE(Has(text.ErrorOf(keys + "rows: 11, circle_diameter_mm: 25"),
                  "less than the circles' distance, 20 mm"));
  EXPECT_TRUE(Has(text.ErrorOf(keys + "rows: 11, asymmetric: yes"), "true or false"));
}

TEST(FrameTarget, Wand) {
  TargetText text;
  const std::string keys = "type: wand, ball_diameter_mm: 16, ";
  const FrameFile frame = text.Read(keys + "distances_mm: [0, 150, 400], sigma_mm: 0.1");
  EXPECT_EQ(frame.setup.target.points[2].xyz_mm, Eigen::Vector3d(400, 0, 0));
  EXPECT_EQ(frame.setup.target.points[2].sigma_mm, 0.1);
  EXPECT_TRUE(Has(text.ErrorOf(keys + "distances_mm: [0, 400, 150]"), "found 150 behind 400"));
  EXPECT_TRUE(Has(text.ErrorOf(keys + "distances_mm: [0]"), "found 1 balls"));
  EXPECT_TRUE(Has(text.ErrorOf(keys + "distances_mm: [0, 0.15, 0.4]"), "metres"));
  EXPECT_TRUE(Has(text.ErrorOf(keys + "distances_mm: [0, 10, 400]"), "only 10 mm apart"));
  text.folder.end = "world: {origin: '0', x_axis: '1', xy_plane: '2'}\n";
  EXPECT_TRUE(Has(text.ErrorOf(keys + "distances_mm: [0, 400]"), "a world for a wand"));
}

TEST(FrameTarget, WorldOfAWand) {
  TargetText text;
  const std::string keys = "type: wand, ball_diameter_mm: 16, distances_mm: [0, 150, 400]";
  const auto world = [&](const std::string& third) {
    text.folder.end =
        "world_points: {ball_diameter_mm: 20, points: [{id: O, xyz_mm: [0, 0, 0]}, "
        "{id: X, xyz_mm: [300, 0, 0]}, {id: Y, xyz_mm: " +
        third + "}]}\nworld: {origin: X, x_axis: O, xy_plane: Y}\n";
  };
  world("[0, 200, 0]");
  EXPECT_TRUE(Has(text.ErrorOf(keys), "the key 'world_images' is missing"));
  text.folder.Write("w.csv", "id,u_px,v_px\nO,1,1\nX,2,2\nY,3,1\n");
  text.folder.cam0 = "images: cam0, world_images: cam0/1.png, world_seeds: w.csv";
  text.folder.cam1 = "images: cam1, world_images: cam1/1.png, world_seeds: w.csv";
  const FrameFile frame = text.Read(keys);
  EXPECT_EQ(frame.world_target->ball_diameter_mm, 20);
  EXPECT_EQ(frame.setup.world->origin, 1);
  EXPECT_EQ(frame.cameras[1].world_seeds[2].point, 2);
  EXPECT_EQ(frame.cameras[1].world_images.size(), 1U);
  world("[600, 0.1, 0]");
  EXPECT_TRUE(Has(text.ErrorOf(keys), "found 3 points on one line"));
}

}  // namespace
}  // namespace stereomotion
