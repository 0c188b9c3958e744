#include "src/capture/file_names.h"

#include <gtest/gtest.h>

namespace stereomotion {
namespace {

using Numbers = std::vector<std::int64_t>;

TEST(NaturalLess, ComparesNumbersAsNumbers) {
  EXPECT_TRUE(NaturalLess("img2.png", "img10.png"));
  EXPECT_FALSE(NaturalLess("img10.png", "img2.png"));
  EXPECT_TRUE(NaturalLess("img09.png", "img10.png"));
  EXPECT_TRUE(NaturalLess("a", "a1"));
  EXPECT_FALSE(NaturalLess("img2.png", "img2.png"));
}

// Law: of two different names exactly one is the lesser, also where they differ by zeros only.
TEST(NaturalLess, IsTotal) { EXPECT_NE(NaturalLess("i02", "i2"), NaturalLess("i2", "i02")); }

TEST(FrameNumbers, ReadsTheLastNumber) {
  EXPECT_EQ(FrameNumbers({"cam1_007.png", "cam1_009.png"}), (Numbers{7, 9}));
}

TEST(FrameNumbers, NamesWithoutNumbers) { EXPECT_FALSE(FrameNumbers({"a.png", "b.png"})); }

TEST(FrameNumbers, NamesThatRepeatANumber) { EXPECT_FALSE(FrameNumbers({"a1.png", "b1.png"})); }

TEST(FrameNumbers, ClockTimesAreNoNumbers) {
  EXPECT_FALSE(FrameNumbers({"1403636579763.png", "1403636579813.png", "1403636579864.png"}));
}

}  // namespace
}  // namespace stereomotion
