#include "stereomotion/capture/recording.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <thread>

#include "stereomotion/capture/sha256.h"
#include "stereomotion/core/user_error.h"
#include "temporary_folder.h"

namespace stereomotion {
namespace {

using testing::TemporaryFolder;

// Writes images whose every pixel is the number in the name.
void WriteImages(const TemporaryFolder& folder, const std::string& camera,
                 const std::vector<int>& numbers) {
  std::filesystem::create_directories(folder.path() / camera);
  for (const int number : numbers) {
    const auto file = folder.path() / camera / ("i" + std::to_string(number) + ".png");
    cv::imwrite(file.string(), cv::Mat(6, 8, CV_8UC1, cv::Scalar(number)));
  }
}

std::unique_ptr<Recording> Open(const TemporaryFolder& folder, double fps = 0) {
  return OpenRecording(folder.path() / "l", folder.path() / "r", {fps, true});
}

std::string ErrorOf(const TemporaryFolder& folder, double fps = 0) {
  try {
    Open(folder, fps);
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Recording, ExposureOutOfRange) {
  TemporaryFolder folder;
  WriteImages(folder, "l", {1});
  WriteImages(folder, "r", {1});
  folder.Write("r/timestamps.csv", "frame,timestamp_ns\n1,0\n");
  for (const char* exposure : {"-5", "nan", "inf", "1e300", "10000001"}) {
    folder.Write("l/timestamps.csv",
                 std::string("frame,timestamp_ns,exposure_us\n1,0,") + exposure);
    EXPECT_TRUE(Contains(ErrorOf(folder), "timestamps.csv:2: found exposure_us ")) << exposure;
  }
  folder.Write("l/timestamps.csv", "frame,timestamp_ns,exposure_us\n1,0,10000000\n");
  EXPECT_EQ(ErrorOf(folder), "no error");
}

TEST(Recording, PairsByTimeAndNaturalOrder) {
  TemporaryFolder folder;
  WriteImages(folder, "l", {9, 10, 11});
  WriteImages(folder, "r", {9, 10});
  folder.Write("l/timestamps.csv",
               "frame,timestamp_ns,exposure_us,trigger\n9,0,500,x\n10,100,,x\n11,200,7,x\n");
  folder.Write("r/timestamps.csv", "timestamp_ns,frame\r\n103,9\r\n199,10\r\n");
  const auto recording = Open(folder);
  ASSERT_EQ(recording->size(), 3);
  EXPECT_EQ(recording->report().unpaired_left, 1);
  EXPECT_EQ(recording->report().unpaired_right, 0);
  EXPECT_TRUE(recording->report().paired_by_time);
  EXPECT_EQ(recording->report().warnings.size(), 1U);
  EXPECT_EQ(recording->report().left_with_exposure, 2);
  EXPECT_EQ(recording->report().right_with_exposure, 0);
  FramePair pair;
  recording->Read(0, pair);
  EXPECT_EQ(pair.left.index, 9);
  EXPECT_EQ(pair.left.exposure_us, 500);
  EXPECT_EQ(pair.right.index, -1);
  EXPECT_TRUE(pair.right.image.empty());
  recording->Read(2, pair);
  EXPECT_EQ(pair.left.timestamp_ns, 200);
  EXPECT_EQ(pair.left.image.View().At(3, 3), 11);
  EXPECT_EQ(pair.right.image.View().At(3, 3), 10);
  EXPECT_THROW(recording->Read(3, pair), std::out_of_range);
}

TEST(Recording, RateGivesTimesAndLostFramesShowInTheNames) {
  TemporaryFolder folder;
  WriteImages(folder, "l", {0, 1, 3});
  WriteImages(folder, "r", {0, 1, 2, 3});
  const auto recording = Open(folder, 10);
  FramePair pair;
  recording->Read(2, pair);
  EXPECT_EQ(pair.left.timestamp_ns, 300'000'000);
  EXPECT_EQ(pair.right.index, 3);
  EXPECT_EQ(recording->report().unpaired_right, 1);
  ASSERT_EQ(recording->report().warnings.size(), 1U);
  EXPECT_TRUE(Contains(recording->report().warnings[0], "1 right frames have no partner"));
  EXPECT_TRUE(Contains(recording->report().warnings[0], "paired by the numbers in the names"));
}

TEST(Recording, NamesShiftedAlikePairByPosition) {
  TemporaryFolder folder;
  WriteImages(folder, "l", {0, 1, 2});
  WriteImages(folder, "r", {1, 2, 3});
  FramePair pair;
  const auto recording = Open(folder, 10);
  recording->Read(1, pair);
  EXPECT_EQ(pair.right.index, 2);
  EXPECT_EQ(recording->report().pairs, 3);
  ASSERT_EQ(recording->report().warnings.size(), 1U);
  EXPECT_TRUE(Contains(recording->report().warnings[0], "l 0 to 2, of "));
  EXPECT_TRUE(Contains(recording->report().warnings[0], "r 1 to 3: paired in order"));
}

// Opens a recording whose right camera is in order and whose left one has these names and rows.
std::vector<std::string> WarningsOf(const std::vector<int>& names, int rows) {
  TemporaryFolder folder;
  WriteImages(folder, "l", names);
  WriteImages(folder, "r", {0, 1, 2, 3});
  std::string csv = "frame,timestamp_ns\n";
  for (int i = 0; i < rows; ++i) csv += std::to_string(i) + "," + std::to_string(100 * i) + "\n";
  folder.Write("l/timestamps.csv", csv);
  folder.Write("r/timestamps.csv", "frame,timestamp_ns\n0,0\n1,100\n2,200\n3,300\n");
  return Open(folder)->report().warnings;
}

TEST(Recording, NamesShiftedAgainstTheRowsAreTold) {
  EXPECT_TRUE(WarningsOf({0, 1, 2, 3}, 4).empty());
  EXPECT_TRUE(WarningsOf({10, 11, 12, 13}, 4).empty());  // no number in common: only one reading
  const auto in_order = WarningsOf({1, 2, 3, 4}, 4);
  ASSERT_EQ(in_order.size(), 1U);
  EXPECT_TRUE(Contains(in_order[0], "the rows are frames 0 to 3, the names are numbered 1 to 4"));
  EXPECT_TRUE(Contains(in_order[0], "taken in order"));
  const auto by_number = WarningsOf({1, 2, 4}, 4);
  ASSERT_EQ(by_number.size(), 3U);
  EXPECT_TRUE(Contains(by_number[2], "names and rows may be shifted"));
  EXPECT_EQ(WarningsOf({0, 1, 2}, 4).size(), 1U);  // the last image is lost: nothing is shifted
}

TEST(Recording, NumbersThatMeetNoRow) {
  TemporaryFolder folder;
  WriteImages(folder, "l", {10, 11, 13});
  WriteImages(folder, "r", {0, 1, 2});
  for (const char* camera : {"l", "r"}) {
    folder.Write(camera + std::string("/timestamps.csv"),
                 "frame,timestamp_ns\n0,0\n1,100\n2,200\n");
  }
  const std::string error = ErrorOf(folder);
  EXPECT_TRUE(Contains(error, "frames 0 to 2, the names are numbered 10 to 13")) << error;
  EXPECT_FALSE(Contains(error, "do not number them")) << error;
}

TEST(Recording, RateOutOfRangeOrWithoutUse) {
  TemporaryFolder folder;
  WriteImages(folder, "l", {0, 1});
  WriteImages(folder, "r", {0, 1});
  for (const double fps : {1e-10, -3.0, 2e6, HUGE_VAL, std::nan("")}) {
    EXPECT_TRUE(Contains(ErrorOf(folder, fps), "expected 0.001 to 1e+06 frames a second")) << fps;
  }
  EXPECT_EQ(ErrorOf(folder, kLowestFps), "no error");
  EXPECT_EQ(ErrorOf(folder, kHighestFps), "no error");
  folder.Write("l/timestamps.csv", "frame,timestamp_ns\n0,0\n1,100\n");
  folder.Write("r/timestamps.csv", "frame,timestamp_ns\n0,0\n1,100\n");
  EXPECT_TRUE(Open(folder)->report().warnings.empty());
  EXPECT_TRUE(Contains(Open(folder, 10)->report().warnings.at(0), "--fps is not used"));
}

TEST(Recording, SingleImageIsNoRecording) {
  TemporaryFolder folder;
  WriteImages(folder, "l", {0, 1});
  WriteImages(folder, "r", {0, 1});
  try {
    OpenRecording(folder.path() / "l/i0.png", folder.path() / "r");
    FAIL() << "expected an error";
  } catch (const UserError& error) {
    EXPECT_TRUE(Contains(error.what(), "l/i0.png: found a single image, expected a folder"));
  }
}

TEST(Recording, UnequalCountsWithoutNumbers) {
  TemporaryFolder folder;
  for (const char* name : {"l/a.png", "l/b.png", "r/a.png"}) {
    std::filesystem::create_directories((folder.path() / name).parent_path());
    cv::imwrite((folder.path() / name).string(), cv::Mat(6, 8, CV_8UC1, cv::Scalar(1)));
  }
  const auto recording = Open(folder, 10);
  EXPECT_EQ(recording->size(), 2);
  EXPECT_EQ(recording->report().unpaired_left, 1);
  EXPECT_TRUE(Contains(recording->report().warnings.at(0), "nothing tells when frames were lost"));
}

TEST(Recording, RowWithoutImageIsALostFrame) {
  TemporaryFolder folder;
  WriteImages(folder, "l", {0, 2});
  WriteImages(folder, "r", {0, 1, 2});
  folder.Write("l/timestamps.csv", "frame,timestamp_ns\n0,0\n1,100\n2,200\n");
  folder.Write("r/timestamps.csv", "frame,timestamp_ns\n0,0\n1,100\n2,200\n");
  const auto recording = Open(folder);
  FramePair pair;
  recording->Read(1, pair);
  EXPECT_TRUE(pair.left.image.empty());
  EXPECT_TRUE(Contains(pair.left.problem, "no image for this row"));
  EXPECT_FALSE(pair.right.image.empty());
}

TEST(Recording, DamagedImageIsThatFramesProblem) {
  TemporaryFolder folder;
  WriteImages(folder, "l", {0, 1});
  WriteImages(folder, "r", {0, 1});
  folder.Write("l/i1.png", "not an image");
  const auto recording = Open(folder, 10);
  FramePair pair;
  recording->Read(1, pair);
  EXPECT_TRUE(Contains(pair.left.problem, "i1.png: not a PNG"));
  recording->Read(0, pair);
  EXPECT_EQ(pair.left.problem, "");
  EXPECT_EQ(pair.left.image.View().width_px, 8);
}

TEST(Recording, ErrorsNameWhatIsWrong) {
  TemporaryFolder folder;
  EXPECT_TRUE(Contains(ErrorOf(folder), "no such folder"));
  std::filesystem::create_directory(folder.path() / "l");
  EXPECT_TRUE(Contains(ErrorOf(folder), "holds no images"));
  WriteImages(folder, "l", {0, 1});
  EXPECT_TRUE(Contains(ErrorOf(folder), "give --fps"));
  WriteImages(folder, "r", {0, 1});
  folder.Write("l/timestamps.csv", "frame,timestamp_ns\n0,0\n1,100\n");
  EXPECT_TRUE(Contains(ErrorOf(folder, 10), "has none; expected both"));
  folder.Write("r/timestamps.csv", "frame,time\n0,0\n1,100\n");
  EXPECT_TRUE(Contains(ErrorOf(folder), "r/timestamps.csv:1: found no column 'timestamp_ns'"));
  folder.Write("r/timestamps.csv", "frame,timestamp_ns\n0,0\n1,abc\n");
  EXPECT_TRUE(Contains(ErrorOf(folder), "timestamps.csv:3: found 'abc' in timestamp_ns"));
  folder.Write("r/timestamps.csv", "frame,timestamp_ns\n0,100\n1,100\n");
  EXPECT_TRUE(Contains(ErrorOf(folder), "expected more than the line before (100)"));
  folder.Write("r/timestamps.csv", "frame,timestamp_ns\n7,0\n8,1\n9,2\n");
  EXPECT_TRUE(Contains(ErrorOf(folder), "found 3 rows for 2 images"));
}

TEST(Recording, SameFolderTwice) {
  TemporaryFolder folder;
  WriteImages(folder, "l", {0, 1});
  EXPECT_THROW(OpenRecording(folder.path() / "l", folder.path() / "l" / "."), UserError);
}

TEST(Recording, DigestIsThatOfSha256sum) {
  TemporaryFolder folder;
  WriteImages(folder, "l", {0, 1});
  WriteImages(folder, "r", {0, 1});
  const auto recording = Open(folder, 10);
  EXPECT_EQ(recording->InputDigest(Side::kLeft), "");
  FramePair pair;
  std::string listing;
  for (int i = 0; i < 2; ++i) {
    recording->Read(i, pair);
    const std::string name = "i" + std::to_string(i) + ".png";
    listing += Sha256OfFile(folder.path() / "l" / name) + "  " + name + "\n";
  }
  Sha256 expected;
  expected.Add(listing.data(), listing.size());
  EXPECT_EQ(recording->InputDigest(Side::kLeft), expected.HexDigest());
}

TEST(Sha256, KnownAnswer) {  // FIPS 180-4's example
  Sha256 hash;
  hash.Add("abc", 3);
  EXPECT_EQ(hash.HexDigest(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Recording, ReadersInParallelGetTheirOwnFrames) {
  TemporaryFolder folder;
  std::vector<int> numbers;
  for (int i = 0; i < 40; ++i) numbers.push_back(i);
  WriteImages(folder, "l", numbers);
  WriteImages(folder, "r", numbers);
  const auto recording = Open(folder, 10);
  std::vector<int> wrong(2, 0);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 2; ++t) {
    threads.emplace_back([&, t] {
      FramePair pair;
      for (int i = static_cast<int>(t); i < 40; i += 2) {
        recording->Read(i, pair);
        if (pair.left.image.View().At(1, 1) != i || pair.right.image.View().At(1, 1) != i)
          ++wrong[t];
      }
    });
  }
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(wrong, (std::vector<int>{0, 0}));
}

bool WriteVideo(const std::filesystem::path& file, int fourcc) {
  cv::VideoWriter writer(file.string(), fourcc, 25, {64, 48});
  if (!writer.isOpened()) return false;
  for (int i = 0; i < 40; ++i) writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(5 * i)));
  return true;
}

TEST(Recording, VideoOutOfOrderAndLossyCodecWarned) {
  TemporaryFolder folder;
  const auto left = folder.path() / "l.avi", right = folder.path() / "r.avi";
  if (!WriteVideo(left, cv::VideoWriter::fourcc('M', 'J', 'P', 'G')) ||
      !WriteVideo(right, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'))) {
    GTEST_SKIP() << "this OpenCV writes no Motion JPEG";
  }
  const auto recording = OpenRecording(left, right);
  ASSERT_EQ(recording->size(), 40);
  EXPECT_EQ(recording->report().warnings.size(), 2U);
  EXPECT_TRUE(Contains(recording->report().warnings.at(0), "lossy"));
  FramePair pair;
  for (const int position : {3, 1, 30, 0, 39, 38}) {
    recording->Read(position, pair);
    ASSERT_EQ(pair.left.problem, "");
    EXPECT_EQ(pair.left.timestamp_ns, position * 40'000'000LL);
    EXPECT_NEAR(pair.left.image.View().At(20, 20), 5 * position, 2);  // frames differ by 5
  }
}

}  // namespace
}  // namespace stereomotion
