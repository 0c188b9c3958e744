#include "stereomotion/io/frame_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "frame_test_support.h"

namespace stereomotion {
namespace {

using testing::Error;
using testing::FrameFolder;
using testing::Has;

TEST(FrameFile, ReadsAllKeys) {
  FrameFolder folder;
  folder.target =
      "  type: control_points\n  ball_diameter_mm: 16\n  points:\n"
      "    - {id: A, xyz_mm: [0, 0, 0], sigma_mm: 0.2}\n    - {id: B, xyz_mm: [400, 0, 0]}\n"
      "    - {id: C, xyz_mm: [0, 300, 0]}\n    - {id: D, xyz_mm: [0, 0, 200]}\n"
      "    - {id: E, xyz_mm: [400, 0, 200]}\n    - {id: F, xyz_mm: [0, 300, 200]}\n"
      "    - {id: G, xyz_mm: [1, 150, 99.5]}\n";
  folder.Write("s.csv", "v_px,u_px,id\r\n2, 1,A\r\n4,3,B\r\n1,1,C\r\n1,1,D\r\n1,1,E\r\n1,1,F\r\n");
  folder.cam0 =
      "source: 'aravis:B', image_size_px: [1280, 1024], images: cam0, seeds: s.csv, "
      "free: [fx, fy, k1], initial: {fx_px: 1800, cx_px: 640, k3: 0.1}";
  folder.end = "world: {origin: A, x_axis: B, xy_plane: C}\ncheck_points: [G]\n";
  const FrameFile frame = folder.Read();
  const CalibrationSetup& setup = frame.setup;
  ASSERT_EQ(setup.target.points.size(), 7U);
  EXPECT_EQ(setup.target.points[0].sigma_mm, 0.2);
  EXPECT_EQ(setup.target.points[1].sigma_mm, 0);
  EXPECT_EQ(setup.target.points[6].xyz_mm, Eigen::Vector3d(1, 150, 99.5));
  const CalibrationCamera& camera = setup.cameras[0];
  EXPECT_EQ(camera.source, "aravis:B");
  EXPECT_EQ(camera.width_px, 1280);
  ASSERT_TRUE(camera.free);
  EXPECT_EQ(*camera.free, (std::array<bool, 9>{true, true, false, false, true}));
  EXPECT_EQ(*camera.initial[0], 1800);
  EXPECT_EQ(*camera.initial[8], 0.1);
  EXPECT_FALSE(camera.initial[1]);
  EXPECT_FALSE(setup.cameras[1].free);
  EXPECT_EQ(setup.world->xy_plane, 2);
  EXPECT_EQ(setup.check_points, std::vector<int>{6});
  EXPECT_EQ(frame.cameras[0].seeds[1].point, 1);
  EXPECT_EQ(frame.cameras[0].seeds[1].pixel_px, Eigen::Vector2d(3, 4));
  EXPECT_EQ(frame.num_views, 2);
  // frame.yaml, s.csv, four images.
  EXPECT_EQ(frame.inputs.size(), 6U);
  EXPECT_EQ(frame.inputs[0].filename(), "frame.yaml");
}

TEST(FrameFile, OneCamera) {
  const testing::TextFile file("frame.yaml",
                               "format: stereomotion-frame/1\ntarget: {type: chessboard, rows: 6, "
                               "cols: 9, spacing_mm: 25}\ncameras: [{name: a}]\n");
  EXPECT_TRUE(Has(Error([&] { ReadFrame(file.path()); }), "found 1 camera(s), expected 2 or more"));
}

TEST(FrameFile, WorldAndCheckPointErrors) {
  FrameFolder folder;
  const auto error = [&](const std::string& end) {
    folder.end = end + "\n";
    return folder.ErrorText();
  };
  EXPECT_TRUE(Has(error("world: {origin: x0, x_axis: x0, xy_plane: x3}"),
                  "world.x_axis: found the same point as origin"));
  EXPECT_TRUE(Has(error("world: {origin: x0, x_axis: x1, xy_plane: x1}"), "one beside it"));
  EXPECT_TRUE(Has(error("world: {origin: P0, x_axis: x1, xy_plane: x3}"), "found 'P0'"));
  EXPECT_TRUE(Has(error("world_points: {}"), "they belong to a wand"));
  EXPECT_TRUE(Has(error("check_points: [x1, y2]"), "did you mean 'x2'?"));
  EXPECT_TRUE(Has(error("check_points: [x1, x1]"), "'x1' twice"));
  EXPECT_TRUE(Has(error("check_points: [x1, x2, x3]"), "that leave 5 points for the fit"));
  EXPECT_EQ(error("check_points: [x1, x2]"), "no error");
}

// Every commented example, with the files that it names made around it.
class FrameExamples : public ::testing::TestWithParam<const char*> {};

TEST_P(FrameExamples, IsValid) {
  const FrameFolder folder;
  for (const char* name : {"left/1.png", "right/1.png", "wand/cam0/1.png", "wand/cam1/1.png",
                           "world/cam0.png", "world/cam1.png"}) {
    folder.Write(name);
  }
  for (const char* camera : {"cam0", "cam1"}) {
    folder.Write(std::string(camera) + "_seeds.csv",
                 "id,u_px,v_px\nP01,1,1\nP02,2,1\nP03,2,2\nP04,1,2\nP05,1,3\nP06,3,1\n");
    folder.Write(std::string(camera) + "_world.csv", "id,u_px,v_px\nO,1,1\nX,2,1\nY,2,2\n");
  }
  std::ifstream example(testing::SourceFile(std::string("calib/") + GetParam()));
  ASSERT_TRUE(example);
  const auto file =
      folder.Write(GetParam(), std::string(std::istreambuf_iterator<char>(example), {}));
  EXPECT_EQ(ReadFrame(file).setup.cameras.size(), 2U);
}

INSTANTIATE_TEST_SUITE_P(Calib, FrameExamples,
                         ::testing::Values("frame_points.yaml", "frame_tags.yaml",
                                           "frame_chessboard.yaml", "frame_circles.yaml",
                                           "frame_wand.yaml"));

}  // namespace
}  // namespace stereomotion
