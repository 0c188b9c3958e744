// A recorder that is killed: whatever it had written a second before must be readable.

#include <fstream>

#include "killed_recorder.h"

namespace stereomotion {
namespace {

using std::chrono::milliseconds;
using testing::CountWholePairs;
using testing::kKilledPairsASecond;
using testing::RecordAndKill;
using testing::TemporaryFolder;

TEST(RecorderCrash, ThreeKills) { testing::KillAndRepair(3); }

// The kernel writes in any order: rows may be on the disk whose images are not.
TEST(RecorderCrash, AfterAPowerCutOnlyWhatWasSynchronisedCounts) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  const std::int64_t taken = RecordAndKill(file, milliseconds(1800));
  std::ofstream(folder.path() / "rec.h5.segments" / "unfinished") << "another boot\n";
  const RepairReport report = RepairRecording(file);
  EXPECT_NE(report.notes.back().find("the computer was started anew"), std::string::npos);
  EXPECT_LT(report.frames[0], taken);  // the last fractions of a second were not synchronised
  const std::int64_t pairs = CountWholePairs(file.string() + ":cam0", file.string() + ":cam1");
  EXPECT_GE(pairs, taken - kKilledPairsASecond);
}

TEST(RecorderCrash, FolderIsReadableAsItIs) {
  TemporaryFolder folder;
  const std::int64_t taken = RecordAndKill(folder.path() / "rec", milliseconds(1300));
  const std::int64_t pairs =
      CountWholePairs(folder.path() / "rec" / "cam0", folder.path() / "rec" / "cam1");
  EXPECT_GE(pairs, taken - kKilledPairsASecond);
}

TEST(RecorderCrash, RepairTwiceAndCutSegments) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  RecordAndKill(file, milliseconds(1500));
  const auto segments = folder.path() / "rec.h5.segments";
  std::filesystem::resize_file(segments / "000001.h5", 1000);  // as no crash would leave it
  const RepairReport report = RepairRecording(file);
  EXPECT_NE(report.notes.front().find("000001.h5: cannot be read as an HDF5 file"),
            std::string::npos)
      << report.notes.front();
  const std::int64_t pairs = CountWholePairs(file.string() + ":cam0", file.string() + ":cam1");
  EXPECT_GT(pairs, 32);
  EXPECT_NE(RepairRecording(file).notes.front().find("there is nothing to repair"),
            std::string::npos);
  EXPECT_EQ(CountWholePairs(file.string() + ":cam0", file.string() + ":cam1"), pairs);
}

}  // namespace
}  // namespace stereomotion
