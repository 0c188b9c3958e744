#include "stereomotion/core/expected.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace stereomotion {
namespace {

enum class Reason { kTooFew, kTooMany };

Expected<double, Reason> Half(int n) {
  if (n < 0) return Unexpected{Reason::kTooFew};
  if (n > 100) return Unexpected{Reason::kTooMany};
  return n / 2.0;
}

TEST(Expected, HoldsValueOrReason) {
  EXPECT_TRUE(Half(3).has_value());
  EXPECT_EQ(*Half(3), 1.5);
  EXPECT_FALSE(Half(-1).has_value());
  EXPECT_EQ(Half(-1).error(), Reason::kTooFew);
  EXPECT_EQ(Half(101).error(), Reason::kTooMany);
}

TEST(Expected, TellsValueFromReasonOfTheSameType) {
  const Expected<int, int> value = 7;
  const Expected<int, int> reason = Unexpected{7};
  EXPECT_TRUE(value);
  EXPECT_FALSE(reason);
  EXPECT_EQ(value.value(), reason.error());
}

TEST(Expected, MovesAndChangesItsValue) {
  Expected<std::unique_ptr<std::string>, Reason> text = std::make_unique<std::string>("ball");
  text->get()->append("s");
  const std::unique_ptr<std::string> taken = std::move(*text);
  EXPECT_EQ(*taken, "balls");
}

}  // namespace
}  // namespace stereomotion
