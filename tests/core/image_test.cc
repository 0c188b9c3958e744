#include "stereomotion/core/image.h"

#include <gtest/gtest.h>

namespace stereomotion {
namespace {

TEST(Image, EmptyUntilResized) {
  Image image;
  EXPECT_TRUE(image.empty());
  EXPECT_TRUE(image.View().empty());
  image.Resize(3, 2, PixelType::kGray8);
  EXPECT_FALSE(image.empty());
  EXPECT_FALSE(image.View().empty());
}

TEST(Image, ReadsBackEveryPixelOfBothStorages) {
  for (const PixelType type : {PixelType::kGray8, PixelType::kGray16}) {
    Image image;
    image.Resize(5, 4, type);
    const auto value = [&](int u, int v) {
      return type == PixelType::kGray8 ? 10 * v + u : 1000 * v + 300 + u;
    };
    for (int v = 0; v < 4; ++v) {
      for (int u = 0; u < 5; ++u) {
        if (type == PixelType::kGray8) {
          image.Row<std::uint8_t>(v)[u] = static_cast<std::uint8_t>(value(u, v));
        } else {
          image.Row<std::uint16_t>(v)[u] = static_cast<std::uint16_t>(value(u, v));
        }
      }
    }
    const ImageView view = image.View();
    for (int v = 0; v < 4; ++v) {
      for (int u = 0; u < 5; ++u) EXPECT_EQ(view.At(u, v), value(u, v));
    }
  }
}

TEST(Image, RowsAreAlignedAndLongEnough) {
  Image image;
  image.Resize(65, 2, PixelType::kGray16);
  EXPECT_GE(image.View().stride_bytes, 130);
  EXPECT_EQ(image.View().stride_bytes % 64, 0);
}

TEST(Image, KeepsItsMemoryWhenResizedToSmaller) {
  Image image;
  image.Resize(640, 480, PixelType::kGray16);
  const auto* const before = image.View().data;
  image.Resize(320, 480, PixelType::kGray8);
  EXPECT_EQ(image.View().data, before);
  image.Resize(640, 480, PixelType::kGray16);
  EXPECT_EQ(image.View().data, before);
}

}  // namespace
}  // namespace stereomotion
