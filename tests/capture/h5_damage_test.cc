// Recording files that are damaged, incomplete, or read by others.

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <random>

#include "recorded_frames.h"
#include "stereomotion/capture/recording.h"
#include "stereomotion/core/user_error.h"
#include "temporary_folder.h"
#include "tests/support/test_rng.h"

// HDF5 asks for as much memory as a damaged file says and bears it when there is none; sanitizers
// would take that for a fault.
extern "C" const char* __asan_default_options() { return "allocator_may_return_null=1"; }
extern "C" const char* __tsan_default_options() { return "allocator_may_return_null=1"; }
// It also forgets memory where it gives a damaged file up.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5\n"; }

namespace stereomotion {
namespace {

using testing::Message;
using testing::TemporaryFolder;

std::unique_ptr<Recording> Open(const std::filesystem::path& file) {
  return OpenRecording(file.string() + ":cam0", file.string() + ":cam1", {0, true});
}

TEST(H5Damage, NoHdf5File) {
  TemporaryFolder folder;
  const auto file = folder.Write("text.h5", "This is no HDF5 file.");
  const std::string text = Message([&] { Open(file); });
  EXPECT_NE(text.find(": cannot be read as an HDF5 file ("), std::string::npos) << text;
  EXPECT_EQ(text.find("HDF5 does not say why"), std::string::npos) << text;
  EXPECT_EQ(Message([&] { Open(folder.path() / "none.h5"); }),
            (folder.path() / "none.h5").string() + ": no such file");
}

TEST(H5Damage, MissingSegmentCostsOnlyItsOwnImages) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  const auto recorder = StartRecorder({file});
  testing::RecordPairs(*recorder, 0, 50);
  recorder->Finish();
  const auto segment = folder.path() / "rec.h5.segments" / "000000.h5";
  const auto saved = folder.path() / "saved.h5";
  std::filesystem::rename(segment, saved);
  const std::string missing = " images are missing; the first: " + segment.string() + ": no such";
  const auto recording = Open(file);
  ASSERT_FALSE(recording->report().warnings.empty());
  EXPECT_NE(recording->report().warnings.front().find(missing), std::string::npos);
  EXPECT_EQ(recording->report().pairs, 50);
  FramePair pair;
  recording->Read(0, pair);
  EXPECT_NE(pair.right.problem.find(segment.string() + ": no such file"), std::string::npos);
  recording->Read(49, pair);
  EXPECT_TRUE(testing::SameImage(pair.left.image.View(), testing::MakeFrame(0, 49)->image.View()));
  // A repair tells of it and takes nothing away: the segment may come back.
  EXPECT_NE(RepairRecording(file).notes.at(1).find(missing), std::string::npos);
  std::filesystem::rename(saved, segment);
  Open(file)->Read(0, pair);
  EXPECT_EQ(pair.right.problem, "");
}

TEST(H5Damage, RecordingWithoutAnySegmentIsRefused) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  const auto recorder = StartRecorder({file});
  testing::RecordPairs(*recorder, 0, 5);
  recorder->Finish();
  std::filesystem::remove_all(folder.path() / "rec.h5.segments");
  EXPECT_NE(Message([&] { Open(file); }).find("000000.h5: no such file"), std::string::npos);
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

TEST(H5Damage, DamagedOnesNeverCrash) {
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

TEST(H5Damage, DamagedMasterIsToldAndMadeAnew) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  const auto recorder = StartRecorder({file});
  testing::RecordPairs(*recorder, 0, 50);
  recorder->Finish();
  std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).seekp(1000) << '!';
  EXPECT_NE(Message([&] { Open(file); }).find("rec.h5: found damaged contents"), std::string::npos);
  EXPECT_EQ(RepairRecording(file).frames[0], 50);
  EXPECT_EQ(Open(file)->size(), 50);
  std::filesystem::remove(file);
  EXPECT_EQ(RepairRecording(file).frames[1], 50);
  EXPECT_EQ(Open(file)->size(), 50);
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
TEST(H5Damage, PythonReadsTheSame) {
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
