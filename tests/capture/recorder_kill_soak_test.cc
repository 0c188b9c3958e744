#include "killed_recorder.h"

namespace stereomotion {
namespace {

TEST(RecorderSoak, TwentyKills) { testing::KillAndRepair(20); }

}  // namespace
}  // namespace stereomotion
