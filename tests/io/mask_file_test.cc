#include "stereomotion/io/mask_file.h"

#include <gtest/gtest.h>

#include "io_test_support.h"

namespace stereomotion::testing {
namespace {

Rig TwoCameras() {
  Rig rig;
  for (const char* name : {"cam0", "cam1"}) {
    RigCamera& camera = rig.cameras.emplace_back();
    camera.name = name;
    camera.width_px = 640;
    camera.height_px = 512;
  }
  return rig;
}

std::string ErrorOf(const std::string& cameras) {
  const TextFile file("mask.yaml", "format: stereomotion-mask/1\ncameras:\n" + cameras);
  return Error([&] { ReadMask(file.path(), TwoCameras()); });
}

TEST(MaskFile, ComesBackAsItWasWritten) {
  const std::vector<CameraMask> masks = {
      {"cam0", {{{{10.25, 20}, {30, 20}, {30, 41.5}}, "a lamp"}, {{{0, 0}, {5, 0}, {5, 5}}, ""}}},
      {"cam1", {}}};
  const std::string text = MaskYaml(masks, "two\nlines");
  EXPECT_TRUE(Has(text, "# a lamp\n")) << text;
  const TextFile file("mask.yaml", text);
  const auto read = ReadMask(file.path(), TwoCameras());
  ASSERT_EQ(read.size(), 2U);
  ASSERT_EQ(read[0].regions.size(), 2U);
  EXPECT_EQ(read[0].regions[0].polygon, masks[0].regions[0].polygon);
  EXPECT_TRUE(read[1].regions.empty());
  EXPECT_EQ(MaskYaml(read, "two lines").substr(0, 12), "# two lines\n");
}

TEST(MaskFile, MarksTheCamerasOwnRegions) {
  const std::vector<CameraMask> masks = {{"cam1", {{{{2, 3}, {6, 3}, {6, 5}, {2, 5}}, ""}}}};
  const Rig rig = TwoCameras();
  EXPECT_TRUE(MakeMask(masks, rig.cameras[0]).empty());
  const ImageMask mask = MakeMask(masks, rig.cameras[1]);
  EXPECT_EQ(mask.width_px(), 640);
  EXPECT_EQ(mask.CountMasked(), 5 * 3);
}

TEST(MaskFile, TooManyCornersInAll) {
  std::string polygon = "    - [";
  for (int i = 0; i < 1000; ++i) polygon += i % 2 == 0 ? "[1, 1]," : "[9, 9],";
  polygon.back() = ']';
  std::string text = "  cam0:\n";
  for (int i = 0; i < 101; ++i) text += polygon + "\n";
  EXPECT_TRUE(Has(ErrorOf(text), "at most 100000 in all polygons"));
}

TEST(MaskFile, NamesWhatIsWrong) {
  EXPECT_TRUE(Has(ErrorOf("  cam2: []\n"), "mask.yaml:3: cameras.cam2: unknown key 'cam2'"));
  EXPECT_TRUE(Has(ErrorOf("  cam2: []\n"), "did you mean 'cam"));
  EXPECT_TRUE(Has(ErrorOf("  cam0: 3\n"), "mask.yaml:3: cameras.cam0: found '3', expected a list"));
  EXPECT_TRUE(Has(ErrorOf("  cam0:\n    - [[1, 2], [3, 4]]\n"),
                  "mask.yaml:4: cameras.cam0[0]: found "
                  "2 corners"));
  EXPECT_TRUE(Has(ErrorOf("  cam0:\n    - [[1, 2], [3, 4], [5]]\n"), "a list of 2 numbers"));
  EXPECT_TRUE(Has(ErrorOf("  cam0:\n    - [[1, 2], [3, x], [5, 6]]\n"), "found 'x'"));
  EXPECT_TRUE(Has(ErrorOf("  cam0:\n    - [[1, 2], [3, 4000], [5, 6]]\n"),
                  "found [3, 4000], expected [u, v] in pixels of an image of 640 x 512 px"));
  EXPECT_TRUE(Has(ErrorOf("  cam0:\n    - [[1.1, 2.1], [1.4, 2.1], [1.4, 2.4]]\n"),
                  "a polygon that covers no pixel"));
  const TextFile other("mask.yaml", "format: stereomotion-rig/1\ncameras: {}\n");
  EXPECT_TRUE(Has(Error([&] { ReadMask(other.path(), TwoCameras()); }), "stereomotion-mask/1"));
}

}  // namespace
}  // namespace stereomotion::testing
