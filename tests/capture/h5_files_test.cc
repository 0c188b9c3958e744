// Recording files that other programs wrote.

#include <gtest/gtest.h>

#include "foreign_h5_file.h"
#include "stereomotion/capture/recording.h"
#include "temporary_folder.h"

namespace stereomotion {
namespace {

using testing::ForeignFile;
using testing::kFrames;
using testing::Layout;
using testing::MakeFrame;
using testing::Message;
using testing::SameImage;
using testing::TemporaryFolder;

std::unique_ptr<Recording> Open(const std::filesystem::path& file) {
  return OpenRecording(file.string() + ":cam0", file.string() + ":cam1", {0, true});
}

TEST(H5Files, OfOtherPrograms) {
  H5open();
  const Layout layouts[] = {
      {"plain", H5T_STD_U8LE, H5T_STD_I64LE, H5T_IEEE_F64LE, false, false},
      {"chunked", H5T_STD_U8LE, H5T_STD_U64LE, H5T_IEEE_F32LE, true, false},
      {"compressed 16 bit", H5T_STD_U16LE, H5T_STD_I64LE, H5T_STD_I32LE, true, true},
      {"big endian 16 bit", H5T_STD_U16BE, H5T_STD_I64BE, H5T_IEEE_F64BE, false, false},
      {"no exposure", H5T_STD_U16LE, H5T_STD_I64LE, 0, false, false}};
  for (const Layout& layout : layouts) {
    SCOPED_TRACE(layout.name);
    TemporaryFolder folder;
    const auto file = folder.path() / "other.h5";
    ForeignFile foreign(file);
    foreign.AddCamera(0, layout);
    foreign.AddCamera(1, layout);
    foreign.Close();
    const auto recording = Open(file);
    ASSERT_EQ(recording->report().pairs, static_cast<int>(kFrames));
    EXPECT_TRUE(recording->report().paired_by_time);
    const bool is_8_bit = H5Tget_size(layout.image_type) == 1;
    FramePair pair;
    for (const int i : {0, 5, 2}) {
      recording->Read(i, pair);
      const auto taken = MakeFrame(1, i, is_8_bit ? PixelType::kGray8 : PixelType::kGray16);
      EXPECT_EQ(pair.right.problem, "");
      EXPECT_TRUE(SameImage(pair.right.image.View(), taken->image.View()));
      EXPECT_EQ(pair.right.timestamp_ns, taken->timestamp_ns);
      EXPECT_EQ(pair.right.index, taken->index);
      if (layout.exposure_type == 0) {
        EXPECT_EQ(pair.right.exposure_us, 0);
      } else {
        EXPECT_NEAR(pair.right.exposure_us, taken->exposure_us, 0.5);
      }
    }
    EXPECT_EQ(recording->InputDigest(Side::kLeft).size(), 64U);
  }
}

/// Makes a file that is right but for one dataset of cam0; returns what opening it says, without
/// the file's name.
template <class T>
std::string Complaint(const std::string& dataset, hid_t type, hid_t native,
                      const std::vector<hsize_t>& size, const std::vector<T>& values) {
  TemporaryFolder folder;
  const auto file = folder.path() / "bad.h5";
  const Layout plain{"", H5T_STD_U8LE, H5T_STD_I64LE, H5T_IEEE_F64LE, false, false};
  ForeignFile foreign(file);
  foreign.AddCamera(1, plain);
  const std::vector<std::int64_t> rising{1, 2, 3, 4, 5, 6};
  if (dataset != "images") foreign.AddImages(0, plain);
  for (const char* column : {"frame", "timestamp_ns"}) {
    if (dataset == column) continue;
    foreign.Add(std::string("/cam0/") + column, H5T_STD_I64LE, H5T_NATIVE_INT64, {kFrames}, rising);
  }
  foreign.Add("/cam0/" + dataset, type, native, size, values);
  foreign.Close();
  const std::string text = Message([&] { Open(file); });
  const std::string start = file.string() + ":/cam0/" + dataset;
  return text.rfind(start, 0) == 0 ? text.substr(start.size()) : text;
}

TEST(H5Files, WhatIsWrongIsNamed) {
  H5open();
  const std::vector<std::int64_t> six{10, 11, 12, 13, 14, 15};
  const hid_t i64 = H5T_STD_I64LE, native = H5T_NATIVE_INT64;
  EXPECT_EQ(Complaint("timestamp_ns", i64, native, {5}, six),
            ": found a dataset of size [5], expected [6], a number a frame");
  EXPECT_EQ(Complaint("timestamp_ns", i64, native, {6, 1}, six),
            ": found a dataset of size [6, 1], expected [6], a number a frame");
  EXPECT_EQ(Complaint("timestamp_ns", H5T_IEEE_F64LE, native, {6}, six),
            ": found 64-bit floating-point numbers, expected 64-bit integers");
  EXPECT_EQ(Complaint<std::int64_t>("timestamp_ns", i64, native, {6}, {1, 2, 3, 3, 4, 5}),
            "[3]: found 3, expected more than the one before (3)");
  EXPECT_EQ(Complaint<std::int64_t>("frame", i64, native, {6}, {-1, 2, 3, 4, 5, 6}),
            "[0]: found -1, expected 0 or more");
  EXPECT_EQ(Complaint<std::int64_t>("pair", i64, native, {6}, {0, -1, 1, 1, 2, 3}),
            "[3]: found 1, expected -1, or more than the pair before (1)");
  EXPECT_EQ(Complaint<std::int64_t>("exposure_us", i64, native, {6}, {0, -5, 1, 1, 2, 3}),
            "[1]: found -5.000000, expected 0 to 10000000 microseconds (0: not known)");
  EXPECT_EQ(Complaint("images", H5T_STD_U8LE, H5T_NATIVE_UINT8, {2, 3}, std::vector<char>(6)),
            ": found a dataset of size [2, 3], expected [frames, height, width]");
  EXPECT_EQ(Complaint("images", H5T_STD_I16LE, H5T_NATIVE_INT16, {1, 2, 3}, std::vector<char>(12)),
            ": found 16-bit signed integers, expected 8- or 16-bit unsigned integers");
  EXPECT_EQ(Complaint("images", H5T_STD_U8LE, H5T_NATIVE_UINT8, {0, 2, 3}, std::vector<char>(1)),
            ": found no images, expected one or more");
}

}  // namespace
}  // namespace stereomotion
