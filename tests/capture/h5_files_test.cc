// Recording files that other programs wrote, and damaged ones.

#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <random>

#include "recorded_frames.h"
#include "stereomotion/capture/recording.h"
#include "stereomotion/core/user_error.h"
#include "temporary_folder.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeFrame;
using testing::Message;
using testing::SameImage;
using testing::TemporaryFolder;

constexpr hsize_t kFrames = 6, kHeight = 23, kWidth = 37;

/// Says how a foreign program lays out its file.
struct Layout {
  const char* name = "";
  hid_t image_type = 0, time_type = 0, exposure_type = 0;
  bool chunked = false, compressed = false;
};

/// Writes files of the layout of FORMATS.md through the HDF5 library.
class ForeignFile {
 public:
  explicit ForeignFile(std::filesystem::path file)
      : file_(std::move(file)),
        h5_(H5Fcreate(file_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {
    for (const char* camera : {"cam0", "cam1"}) {
      H5Gclose(H5Gcreate2(h5_, camera, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    }
  }
  ~ForeignFile() { Close(); }
  ForeignFile(const ForeignFile&) = delete;
  ForeignFile& operator=(const ForeignFile&) = delete;
  void Close() {
    if (h5_ >= 0) H5Fclose(h5_);
    h5_ = -1;
  }

  template <class T>
  void Add(const std::string& name, hid_t type, hid_t native, std::vector<hsize_t> size,
           const std::vector<T>& values, const Layout& layout = {}) const {
    const hid_t space = H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr);
    const hid_t list = H5Pcreate(H5P_DATASET_CREATE);
    size[0] = 2;
    if (layout.chunked) H5Pset_chunk(list, static_cast<int>(size.size()), size.data());
    if (layout.compressed) H5Pset_deflate(list, 4);
    const hid_t dataset =
        H5Dcreate2(h5_, name.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT);
    H5Dwrite(dataset, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(dataset);
    H5Pclose(list);
    H5Sclose(space);
  }
  void AddImages(int camera, const Layout& layout) const {
    const bool is_8_bit = H5Tget_size(layout.image_type) == 1;
    const PixelType type = is_8_bit ? PixelType::kGray8 : PixelType::kGray16;
    std::vector<std::uint8_t> bytes;
    for (hsize_t i = 0; i < kFrames; ++i) {
      const auto frame = MakeFrame(camera, static_cast<std::int64_t>(i), type);
      for (int v = 0; v < static_cast<int>(kHeight); ++v) {
        const auto* row = frame->image.View().Row<std::uint8_t>(v);
        bytes.insert(bytes.end(), row, row + kWidth * (is_8_bit ? 1 : 2));
      }
    }
    Add("/cam" + std::to_string(camera) + "/images", layout.image_type,
        is_8_bit ? H5T_NATIVE_UINT8 : H5T_NATIVE_UINT16, {kFrames, kHeight, kWidth}, bytes, layout);
  }
  void AddCamera(int camera, const Layout& layout) const {
    const std::string group = "/cam" + std::to_string(camera) + "/";
    std::vector<std::int64_t> numbers, times;
    std::vector<double> exposures;
    for (hsize_t i = 0; i < kFrames; ++i) {
      const auto frame = MakeFrame(camera, static_cast<std::int64_t>(i));
      numbers.push_back(frame->index);
      times.push_back(frame->timestamp_ns);
      exposures.push_back(frame->exposure_us);
    }
    AddImages(camera, layout);
    Add(group + "frame", H5T_STD_I32LE, H5T_NATIVE_INT64, {kFrames}, numbers, layout);
    Add(group + "timestamp_ns", layout.time_type, H5T_NATIVE_INT64, {kFrames}, times, layout);
    if (layout.exposure_type != 0) {
      Add(group + "exposure_us", layout.exposure_type, H5T_NATIVE_DOUBLE, {kFrames}, exposures,
          layout);
    }
  }

 private:
  std::filesystem::path file_;
  hid_t h5_;
};

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

TEST(H5Files, NoHdf5File) {
  TemporaryFolder folder;
  const auto file = folder.Write("text.h5", "This is no HDF5 file.");
  EXPECT_NE(Message([&] { Open(file); }).find(": cannot be read as an HDF5 file ("),
            std::string::npos);
  EXPECT_EQ(Message([&] { Open(folder.path() / "none.h5"); }),
            (folder.path() / "none.h5").string() + ": no such file");
}

TEST(H5Files, MissingSegmentIsNamed) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  const auto recorder = StartRecorder({file});
  testing::RecordPairs(*recorder, 0, 50);
  recorder->Finish();
  const auto segment = folder.path() / "rec.h5.segments" / "000001.h5";
  std::filesystem::remove(segment);
  EXPECT_EQ(Message([&] { Open(file); }), segment.string() + ": no such file");
}

// Every image is read or said to be unreadable; nothing crashes.
void ReadAll(const std::filesystem::path& file) {
  try {
    const auto recording = Open(file);
    FramePair pair;
    for (std::int64_t i = 0; i < recording->size(); ++i) {
      recording->Read(i, pair);
      EXPECT_EQ(pair.left.image.empty(), !pair.left.problem.empty());
    }
  } catch (const UserError&) {
    // Said in words: what a damaged file may do.
  }
}

void Damage(const std::filesystem::path& file, std::mt19937_64& rng, bool truncate) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  in.close();
  // The first bytes are HDF5's own: most of what can go wrong is there.
  const std::size_t reach = std::min<std::size_t>(bytes.size(), 8000);
  if (truncate) bytes.resize(rng() % bytes.size());
  for (int i = 0; !truncate && i < 4; ++i) {
    bytes[rng() % reach] = static_cast<char>(rng());
  }
  std::ofstream(file, std::ios::binary) << bytes;
}

TEST(H5Files, DamagedOnesNeverCrash) {
  auto rng = testing::MakeTestRng();
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  const auto segment = folder.path() / "rec.h5.segments" / "000000.h5";
  const auto recorder = StartRecorder({file});
  testing::RecordPairs(*recorder, 0, 20);
  recorder->Finish();
  for (const auto& damaged : {file, segment}) {
    const auto whole = damaged.string() + ".whole";
    std::filesystem::copy_file(damaged, whole);
    for (int i = 0; i < 100; ++i) {
      Damage(damaged, rng, i % 2 == 0);
      ReadAll(file);
      std::filesystem::copy_file(whole, damaged, std::filesystem::copy_options::overwrite_existing);
    }
    std::filesystem::remove(whole);
  }
  EXPECT_EQ(Open(file)->size(), 20);
}

std::string OutputOf(const std::string& command) {
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  char buffer[256];
  while (std::fgets(buffer, sizeof(buffer), pipe) != nullptr) text += buffer;
  pclose(pipe);
  return text;
}

// What docs/formats.md says of the file and of its digest, word by word in Python.
TEST(H5Files, PythonReadsTheSame) {
  if (OutputOf("/usr/bin/python3 -c 'import h5py; print(1)' 2>/dev/null") != "1\n") {
    GTEST_SKIP() << "no h5py for /usr/bin/python3 (apt: python3-h5py)";
  }
  TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "made");
  const auto made = folder.path() / "made" / "rec.h5";
  const auto recorder = StartRecorder({made});
  testing::RecordPairs(*recorder, 0, 300, PixelType::kGray16);
  recorder->Finish();
  std::filesystem::rename(folder.path() / "made", folder.path() / "moved");
  const auto file = folder.path() / "moved" / "rec.h5";
  const auto recording = Open(file);
  FramePair pair;
  for (std::int64_t i = 0; i < recording->size(); ++i) recording->Read(i, pair);
  const std::string script = folder.Write("digest.py", R"(
import h5py, hashlib, sys
camera = h5py.File(sys.argv[1])["cam1"]
digest = hashlib.sha256()
for image, frame, time in zip(camera["images"], camera["frame"], camera["timestamp_ns"]):
    line = f"{hashlib.sha256(image.tobytes()).hexdigest()}  {frame},{time}\n"
    digest.update(line.encode())
print(digest.hexdigest())
)");
  EXPECT_EQ(OutputOf("cd / && /usr/bin/python3 " + script + " " + file.string()),
            recording->InputDigest(Side::kRight) + "\n");
}

}  // namespace
}  // namespace stereomotion
