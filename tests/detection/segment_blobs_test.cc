#include "src/detection/segment_blobs.h"

#include <gtest/gtest.h>

#include <queue>
#include <set>

#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::Uniform;

/// Counts 8-connected components by flooding.
int FloodCount(const std::vector<std::vector<bool>>& bright) {
  const int rows = static_cast<int>(bright.size());
  const int columns = static_cast<int>(bright[0].size());
  auto seen = bright;
  int count = 0;
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < columns; ++u) {
      if (!seen[v][u]) continue;
      ++count;
      std::queue<std::pair<int, int>> open;
      open.push({v, u});
      seen[v][u] = false;
      while (!open.empty()) {
        const auto [y, x] = open.front();
        open.pop();
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            const int b = y + dy;
            const int a = x + dx;
            if (a < 0 || b < 0 || a >= columns || b >= rows || !seen[b][a]) continue;
            seen[b][a] = false;
            open.push({b, a});
          }
        }
      }
    }
  }
  return count;
}

TEST(RunList, ComponentsEqualFlooding) {
  auto rng = MakeTestRng();
  for (int round = 0; round < 200; ++round) {
    const double density = Uniform(rng, 0.1, 0.7);
    std::vector<std::vector<bool>> bright(17, std::vector<bool>(23));
    RunList list;
    list.Start(17);
    for (int v = 0; v < 17; ++v) {
      for (int u = 0; u < 23; ++u) {
        bright[v][u] = Uniform(rng, 0, 1) < density;
        if (bright[v][u]) list.Append(v, u, u + 1);
      }
    }
    list.Connect();
    EXPECT_EQ(list.num_labels, FloodCount(bright));
    std::set<int> labels;
    for (const auto& run : list.runs) labels.insert(run.label);
    EXPECT_EQ(static_cast<int>(labels.size()), list.num_labels);
  }
}

Image FlatImage(int width, int height, int grey) {
  Image image;
  image.Resize(width, height, PixelType::kGray8);
  for (int v = 0; v < height; ++v) std::fill_n(image.Row<std::uint8_t>(v), width, grey);
  return image;
}

TEST(Segmenter, CutsAtHalfHeightAndKeepsMoments) {
  Image image = FlatImage(100, 70, 10);
  for (int v = 20; v < 30; ++v) std::fill_n(image.Row<std::uint8_t>(v) + 40, 8, 110);
  for (int v = 20; v < 30; ++v) image.Row<std::uint8_t>(v)[48] = 40;  // above threshold, below half
  BackgroundMap map;
  EstimateBackground(image.View(), SensorNoise{}, 64, map);
  Segmenter segmenter;
  segmenter.Segment(image.View(), map, 6);
  ASSERT_EQ(segmenter.blobs().size(), 1U);
  const Blob& blob = segmenter.blobs()[0];
  EXPECT_EQ(blob.area_px, 80);
  EXPECT_DOUBLE_EQ(blob.sum_u / blob.area_px, 43.5);
  EXPECT_DOUBLE_EQ(blob.sum_v / blob.area_px, 24.5);
  EXPECT_DOUBLE_EQ(blob.sum_uu / blob.area_px - 43.5 * 43.5, (64.0 - 1) / 12);
  EXPECT_EQ(blob.peak_dn, 110);
}

TEST(Segmenter, SplitsTwoBlobsThatTouchOnlyInTheirTails) {
  Image image = FlatImage(100, 70, 10);
  for (int v = 20; v < 30; ++v) {
    std::fill_n(image.Row<std::uint8_t>(v) + 40, 20, 50);
    std::fill_n(image.Row<std::uint8_t>(v) + 40, 8, 210);
    std::fill_n(image.Row<std::uint8_t>(v) + 52, 8, 210);
  }
  BackgroundMap map;
  EstimateBackground(image.View(), SensorNoise{}, 64, map);
  Segmenter segmenter;
  segmenter.Segment(image.View(), map, 6);
  ASSERT_EQ(segmenter.blobs().size(), 2U);
  EXPECT_EQ(segmenter.blobs()[0].parent, segmenter.blobs()[1].parent);
}

TEST(BackgroundMap, FollowsUnevenLightAndIgnoresBalls) {
  Image image = FlatImage(640, 320, 0);
  for (int v = 0; v < 320; ++v) {
    for (int u = 0; u < 640; ++u) {
      const bool ball = (u - 300) * (u - 300) + (v - 160) * (v - 160) < 30 * 30;
      image.Row<std::uint8_t>(v)[u] = static_cast<std::uint8_t>(ball ? 250 : 20 + u / 10);
    }
  }
  BackgroundMap map;
  EstimateBackground(image.View(), SensorNoise{}, 64, map);
  for (int u = 64; u < 576; u += 16) {
    EXPECT_NEAR(map.level_dn[static_cast<std::size_t>(map.CellAt(u, 160))], 20 + u / 10.0, 5) << u;
  }
}

}  // namespace
}  // namespace stereomotion
