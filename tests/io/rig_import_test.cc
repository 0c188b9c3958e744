#include <gtest/gtest.h>

#include "io_test_support.h"
#include "stereomotion/io/rig_export.h"
#include "stereomotion/io/rig_file.h"

namespace stereomotion {
namespace {

using testing::Error;
using testing::Has;
using testing::TemporaryFolder;
using testing::TextFile;

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

// The right camera is turned by 90° about its axis and stands 0.2 m to the right of the left one.
struct RosText {
  std::string left = Info("left", "1, 0, 0, 0, 1, 0, 0, 0, 1", "0");
  std::string right = Info("narrow/right", "0, -1, 0, 1, 0, 0, 0, 0, 1", "-80");

  static std::string Info(const std::string& name, const std::string& rotation,
                          const std::string& shift) {
    return "image_width: 640\nimage_height: 480\ncamera_name: " + name +
           "\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data: [500, 0, 320, 0, 500, 240, 0, 0, 1]\n"
           "distortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n"
           "  data: [0, 0, 0, 0, 0]\nrectification_matrix:\n  rows: 3\n  cols: 3\n  data: [" +
           rotation + "]\nprojection_matrix:\n  rows: 3\n  cols: 4\n  data: [400, 0, 300, " +
           shift + ", 0, 400, 250, 0, 0, 0, 1, 0]\n";
  }
  [[nodiscard]] Rig Read() const {
    const TemporaryFolder folder;
    return ReadRosCameraInfo(folder.Write("left.yaml", left), folder.Write("right.yaml", right));
  }
};

TEST(RosCameraInfo, ProjectsAKnownPoint) {
  const Rig rig = RosText().Read();
  EXPECT_EQ(rig.cameras[0].name, "left");
  EXPECT_EQ(rig.cameras[1].name, "right");
  const Eigen::Vector3d p_mm(100, 50, 1000);
  // Left: 320 + 500 · 0.1, 240 + 500 · 0.05. Right, rectified: (100 − 200, 50, 1000); turned back
  // by Rᵀ: (50, 100, 1000).
  EXPECT_LT((*ProjectWorldPoint(rig.cameras[0], p_mm) - Eigen::Vector2d(370, 265)).norm(), 1e-9);
  EXPECT_LT((*ProjectWorldPoint(rig.cameras[1], p_mm) - Eigen::Vector2d(345, 290)).norm(), 1e-9);
}

TEST(RosCameraInfo, Errors) {
  const auto error = [](const std::string& from, const std::string& to) {
    RosText text;
    text.right = Replaced(text.right, from, to);
    return Error([&] { return text.Read(); });
  };
  EXPECT_TRUE(Has(error("-80", "0"), "found no shift in its last column"));
  EXPECT_TRUE(Has(error("-80", "-800000"), "stand 2e+06 mm apart"));
  EXPECT_TRUE(Has(error("0, -1, 0, 1", "0, -1, 0, 2"), "expected a rotation"));
  EXPECT_TRUE(Has(error("plumb_bob", "equidistant"), "found 'equidistant', expected 'plumb_bob'"));
  EXPECT_TRUE(Has(error("camera_matrix", "K"), "expected a ROS camera_info file"));
  EXPECT_TRUE(Has(error("[500, 0,", "[500, 1,"), "a skewed matrix"));
  const TextFile alone("left.yaml", RosText().left);
  EXPECT_TRUE(Has(Error([&] { ReadRig(alone.path()); }), "convert left.yaml right.yaml --to rig"));
}

// Two cameras 2 m before the origin, f = 1000 px, principal point (600, 400), 500 mm apart.
constexpr const char* kDlt =
    "0.5,0.5\n0,0\n0.3,0.3\n600,350\n0,0\n0.5,0.5\n0.2,0.2\n400,400\n0,0\n0,0\n0.0005,0.0005\n";
// The same for v counted upwards from the image's lower edge, 1001 rows, u from 1.
constexpr const char* kUpwards =
    "0.5,0.5\n0,0\n0.3005,0.3005\n601,351\n0,0\n-0.5,-0.5\n0.3,0.3\n600,600\n0,0\n0,0\n"
    "0.0005,0.0005\n";

TEST(DltCsv, ProjectsAKnownPoint) {
  const Eigen::Vector3d p_mm(100, -200, 500);  // 2500 mm before the cameras
  for (const auto& [text, pixels] :
       {std::pair{kDlt, DltPixels::kZeroBased}, {kUpwards, DltPixels::kDltdv5}}) {
    const TextFile file("dlt.csv", text);
    const Rig rig = ReadDltCsv(file.path(), {{1280, 1001}}, {pixels, 1}).rig;
    const RigCamera& left = rig.cameras[0];
    EXPECT_LT((*ProjectWorldPoint(left, p_mm) - Eigen::Vector2d(640, 320)).norm(), 1e-9);
    EXPECT_LT((*ProjectWorldPoint(rig.cameras[1], p_mm) - Eigen::Vector2d(440, 320)).norm(), 1e-9);
    EXPECT_NEAR(left.model.fx_px, 1000, 1e-9);
    EXPECT_NEAR(left.cam_from_world.translation_mm.z(), 2000, 1e-9);
  }
}

TEST(DltCsv, FrameInMetres) {
  // Coefficients of a frame in metres: those of lengths are a thousand times as large.
  const TextFile file("dlt.csv",
                      "500,500\n0,0\n300,300\n600,350\n0,0\n500,500\n200,200\n400,400\n"
                      "0,0\n0,0\n0.5,0.5\n");
  const auto sizes = std::vector<Eigen::Vector2i>{{1280, 1024}, {1280, 1000}};
  EXPECT_TRUE(Has(Error([&] { ReadDltCsv(file.path(), sizes); }), "in metres?"));
  const Rig rig = ReadDltCsv(file.path(), sizes, {DltPixels::kZeroBased, 1000}).rig;
  EXPECT_NEAR(rig.cameras[1].cam_from_world.translation_mm.x(), -500, 1e-9);
  EXPECT_EQ(rig.cameras[1].height_px, 1000);
}

TEST(DltCsv, SkewIsTold) {
  const auto read = [](const std::string& l2) {
    const TextFile file("dlt.csv", Replaced(kDlt, "0,0\n", l2 + ",0\n"));
    return ReadDltCsv(file.path(), {{1280, 1000}});
  };
  // L2 = skew / depth: 2 px of skew, 2 · 500 / 1000 px at the upper and lower edge.
  const ImportedRig imported = read("0.001");
  ASSERT_EQ(imported.notes.size(), 1U);
  EXPECT_TRUE(Has(imported.notes[0], "column 1: the skew of 2 px")) << imported.notes[0];
  EXPECT_TRUE(Has(imported.notes[0], "up to 1 px at the image's edge")) << imported.notes[0];
  EXPECT_TRUE(Has(Error([&] { read("0.01"); }), "found a skew of 20 px"));
}

TEST(DltCsv, Errors) {
  const auto error = [](const std::string& text) {
    const TextFile file("dlt.csv", text);
    return Error([&] { ReadDltCsv(file.path(), {{1280, 1001}}); });
  };
  EXPECT_TRUE(Has(error(kUpwards), "origin lies behind the camera: v counts upwards"));
  EXPECT_TRUE(Has(error("1,2\n3,4\n"), "found 2 rows, expected the 11 DLT coefficients"));
  EXPECT_TRUE(Has(error(Replaced(kDlt, "600,350", "600,x")), "dlt.csv:4: found 'x'"));
  EXPECT_TRUE(Has(error(Replaced(kDlt, "600,350", "600")), "dlt.csv:4: found 1 columns"));
  EXPECT_TRUE(
      Has(error("1,1\n1,1\n1,1\n1,1\n1,1\n1,1\n1,1\n1,1\n1,1\n1,1\n1,1\n"), "rank below 3"));
  const TextFile file("dlt.csv", kDlt);
  EXPECT_TRUE(Has(Error([&] {
                    ReadDltCsv(file.path(), {{1, 1}, {1, 1}, {1, 1}});
                  }),
                  "found 3 image sizes for 2 cameras"));
  EXPECT_TRUE(Has(Error([&] { ReadRig(file.path()); }), "--image-size 1280x1024 --to rig"));
}

}  // namespace
}  // namespace stereomotion
