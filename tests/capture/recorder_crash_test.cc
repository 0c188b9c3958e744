// A recorder that is killed: whatever it had written a second before must be readable.

#include <hdf5.h>

#include <fstream>

#include "killed_recorder.h"

namespace stereomotion {
namespace {

using std::chrono::milliseconds;
using testing::CountWholePairs;
using testing::kKilledPairsASecond;
using testing::RecordAndKill;
using testing::TemporaryFolder;

// What cam0's segments say was brought to the disk. Half of the second one is taken back, so that
// the sum differs from what was written.
std::int64_t CountSynced(const std::filesystem::path& segments) {
  std::int64_t sum = 0;
  for (const auto& entry : std::filesystem::directory_iterator(segments)) {
    if (entry.path().extension() != ".h5") continue;
    const hid_t h5 = H5Fopen(entry.path().c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t dataset = H5Dopen2(h5, "/cam0/synced", H5P_DEFAULT);
    std::int64_t synced = 0;
    H5Dread(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &synced);
    if (entry.path().filename() == "000001.h5") {
      synced /= 2;
      H5Dwrite(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &synced);
    }
    H5Dclose(dataset);
    H5Fclose(h5);
    sum += synced;
  }
  return sum;
}

TEST(RecorderCrash, ThreeKills) { testing::KillAndRepair(3); }

// The kernel writes in any order: rows may be on the disk whose images are not.
TEST(RecorderCrash, AfterAPowerCutOnlyWhatWasSynchronisedCounts) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  const std::int64_t taken = RecordAndKill(file, milliseconds(1800));
  std::ofstream(folder.path() / "rec.h5.segments" / "unfinished") << "another boot\n";
  const auto synced = CountSynced(folder.path() / "rec.h5.segments");
  const RepairReport report = RepairRecording(file);
  EXPECT_EQ(report.frames[0], synced);
  EXPECT_NE(report.notes.back().find("the computer was started anew"), std::string::npos);
  const std::int64_t pairs = CountWholePairs(file.string() + ":cam0", file.string() + ":cam1");
  constexpr std::int64_t kTakenBack = 16;  // half of the second segment
  EXPECT_GE(pairs, taken - kKilledPairsASecond - kTakenBack);
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
