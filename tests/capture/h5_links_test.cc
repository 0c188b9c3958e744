// Recording files that lead to others: virtual datasets, symbolic links, several spellings.

#include <gtest/gtest.h>

#include <fstream>

#include "foreign_h5_file.h"
#include "stereomotion/capture/recording.h"
#include "temporary_folder.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;
using testing::kFrames;
using testing::kHeight;
using testing::kWidth;
using testing::Message;
using testing::SameImage;
using testing::TemporaryFolder;

const testing::Layout& Plain() {
  static const testing::Layout layout{"", H5T_STD_U8LE, H5T_STD_I64LE, 0, false, false};
  return layout;
}

std::unique_ptr<Recording> Open(const fs::path& file) {
  return OpenRecording(file.string() + ":cam0", file.string() + ":cam1");
}

/// Makes a file whose cam0 takes its images from elsewhere; cam1 and all times are its own.
void MakeVirtual(const fs::path& file, const std::string& source, const std::string& dataset) {
  {
    const testing::ForeignFile foreign(file);
    foreign.AddCamera(1, Plain());
    const std::vector<std::int64_t> times{1, 2, 3, 4, 5, 6};
    foreign.Add("/cam0/timestamp_ns", H5T_STD_I64LE, H5T_NATIVE_INT64, {kFrames}, times);
  }
  const hid_t h5 = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hsize_t size[] = {kFrames, kHeight, kWidth};
  const hid_t space = H5Screate_simple(3, size, nullptr);
  const hid_t list = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_virtual(list, space, source.c_str(), dataset.c_str(), space);
  H5Dclose(H5Dcreate2(h5, "/cam0/images", H5T_STD_U8LE, space, H5P_DEFAULT, list, H5P_DEFAULT));
  H5Pclose(list);
  H5Sclose(space);
  H5Fclose(h5);
}

// HDF5 itself crashes on a circle and makes black images of what is not there.
TEST(H5Links, CirclesAndNothingAreRefused) {
  H5open();
  TemporaryFolder folder;
  const auto a = folder.path() / "a.h5", b = folder.path() / "b.h5";
  MakeVirtual(a, ".", "/cam0/images");
  EXPECT_NE(Message([&] { Open(a); }).find("with a virtual dataset again"), std::string::npos);
  MakeVirtual(a, "a.h5", "/cam0/images");
  EXPECT_NE(Message([&] { Open(a); }).find("with a virtual dataset again"), std::string::npos);
  MakeVirtual(a, "b.h5", "/cam0/images");
  MakeVirtual(b, "a.h5", "/cam0/images");
  EXPECT_NE(Message([&] { Open(a); }).find("b.h5 with a virtual dataset again"), std::string::npos);
  MakeVirtual(a, "c.h5", "/cam0/images");
  EXPECT_NE(Message([&] { Open(a); }).find("c.h5: no such file"), std::string::npos);
}

TEST(H5Links, OthersVirtualDatasetsAreRead) {
  H5open();
  for (const bool compressed : {false, true}) {
    TemporaryFolder folder;
    {
      testing::Layout layout = Plain();
      layout.chunked = layout.compressed = compressed;
      const testing::ForeignFile foreign(folder.path() / "source.h5");
      foreign.AddCamera(0, layout);
    }
    const auto file = folder.path() / "virtual.h5";
    MakeVirtual(file, "source.h5", "/cam0/images");
    FramePair pair;
    Open(file)->Read(3, pair);
    EXPECT_EQ(pair.left.problem, "");
    EXPECT_TRUE(SameImage(pair.left.image.View(), testing::MakeFrame(0, 3)->image.View()));
  }
}

TEST(H5Links, SymbolicLinkAndOtherSpellings) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5", link = folder.path() / "links" / "today.h5";
  const auto recorder = StartRecorder({file});
  recorder->Take(testing::MakeFrame(0, 0), nullptr);  // by time it would be a pair with the next
  recorder->Take(nullptr, testing::MakeFrame(1, 0));
  testing::RecordPairs(*recorder, 1, 3);
  recorder->Finish();
  fs::create_directory(link.parent_path());
  fs::create_symlink("../rec.h5", link);
  const auto recording = OpenRecording(file.string() + ":cam0", link.string() + ":cam1");
  EXPECT_EQ(recording->report().pairs, 2);  // as recorded
  FramePair pair;
  recording->Read(1, pair);
  EXPECT_TRUE(SameImage(pair.right.image.View(), testing::MakeFrame(1, 1)->image.View()));
  EXPECT_NE(Message([&] {
              OpenRecording(file.string() + ":cam0", link.string() + ":cam0");
            }).find("left and right are the same"),
            std::string::npos);
  // A repair writes the file, not over the link.
  fs::remove(file.string() + ".segments/unfinished");
  std::ofstream(file, std::ios::app) << "damaged";
  std::ofstream(file.string() + ".segments/unfinished") << "another boot\n";
  EXPECT_TRUE(NeedsRepair(link));
  EXPECT_EQ(RepairRecording(link).frames[0], 3);
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(Open(link)->report().pairs, 2);
}

// Columns that were never written take no room in the file, but would in memory.
TEST(H5Links, MoreRowsThanAFileCanHold) {
  H5open();
  TemporaryFolder folder;
  const auto file = folder.path() / "large.h5";
  const hid_t h5 = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t size[] = {1 << 28, 8, 8}, chunk[] = {1, 8, 8};
  const hid_t space = H5Screate_simple(3, size, nullptr);
  const hid_t list = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(list, 3, chunk);
  for (const char* camera : {"/cam0", "/cam1"}) {
    H5Gclose(H5Gcreate2(h5, camera, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Dclose(H5Dcreate2(h5, (std::string(camera) + "/images").c_str(), H5T_STD_U8LE, space,
                        H5P_DEFAULT, list, H5P_DEFAULT));
  }
  H5Pclose(list);
  H5Sclose(space);
  H5Fclose(h5);
  const std::string text = Message([&] {
    OpenRecording(file.string() + ":cam0", file.string() + ":cam1", {100.0, false});
  });
  EXPECT_NE(text.find("found 268435456 rows in a file of"), std::string::npos) << text;
}

}  // namespace
}  // namespace stereomotion
