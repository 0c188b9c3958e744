#include "stereomotion/capture/read_image.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "temporary_folder.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using Bytes = std::vector<std::uint8_t>;

cv::Mat Pattern(int type) {
  cv::Mat image(37, 53, type);
  auto rng = testing::MakeTestRng();
  for (int v = 0; v < image.rows; ++v) {
    for (std::size_t i = 0; i < image.cols * image.elemSize(); ++i) {
      image.ptr(v)[i] = static_cast<std::uint8_t>(testing::Uniform(rng, 0, 256));
    }
  }
  return image;
}

Bytes Encoded(const std::string& ending, const cv::Mat& image) {
  Bytes bytes;
  EXPECT_TRUE(cv::imencode(ending, image, bytes));
  return bytes;
}

bool SamePixels(const ImageView& view, const cv::Mat& image) {
  if (view.width_px != image.cols || view.height_px != image.rows) return false;
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const double expected =
          image.depth() == CV_8U ? image.at<std::uint8_t>(v, u) : image.at<std::uint16_t>(v, u);
      if (view.At(u, v) != expected) return false;
    }
  }
  return true;
}

class LosslessFormat : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(DecodeImage, LosslessFormat, ::testing::Values(".png", ".tiff", ".pgm"));

TEST_P(LosslessFormat, EightAndSixteenBitsExactly) {
  for (const int type : {CV_8UC1, CV_16UC1}) {
    const cv::Mat image = Pattern(type);
    Image decoded;
    for (int pass = 0; pass < 2; ++pass) {  // the second decodes into the first one's memory
      EXPECT_EQ(DecodeImage(Encoded(GetParam(), image), decoded), "");
      EXPECT_TRUE(SamePixels(decoded.View(), image));
    }
  }
}

TEST_P(LosslessFormat, EveryTruncationFailsAsAWhole) {
  const cv::Mat image = Pattern(CV_8UC1);
  const Bytes whole = Encoded(GetParam(), image);
  Image decoded;
  ::testing::internal::CaptureStderr();
  for (std::size_t size = 0; size < whole.size(); size += 13) {
    const Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    // A TIFF's last bytes may be none of its pixels'; but no pixel may be missing.
    const bool failed = !DecodeImage(part, decoded).empty();
    EXPECT_EQ(failed, decoded.empty()) << size << " of " << whole.size();
    EXPECT_TRUE(failed || SamePixels(decoded.View(), image)) << size << " of " << whole.size();
    EXPECT_TRUE(failed || size + 13 >= whole.size());
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

void Add16(Bytes& bytes, unsigned value) {
  bytes.push_back(static_cast<std::uint8_t>(value & 0xFF));
  bytes.push_back(static_cast<std::uint8_t>(value >> 8));
}

// Makes a TIFF whose directory stands before its pixels, as many cameras write it.
Bytes TiffWithPixelsLast(unsigned width, unsigned height) {
  constexpr unsigned kEntries = 8, kPixels = 8 + 2 + kEntries * 12 + 4;
  const unsigned entries[kEntries][2] = {
      {256, width}, {257, height},  {258, 8},      {259, 1},
      {262, 1},     {273, kPixels}, {278, height}, {279, width * height}};
  Bytes bytes = {'I', 'I', 42, 0, 8, 0, 0, 0};
  Add16(bytes, kEntries);
  for (const auto& [tag, value] : entries) {
    for (const unsigned word : {tag, 4U, 1U, 0U, value, 0U}) Add16(bytes, word);
  }
  bytes.resize(kPixels, 0);
  bytes.resize(kPixels + width * height, 77);
  return bytes;
}

TEST(DecodeImage, TiffWithPixelsLastTruncated) {
  Bytes bytes = TiffWithPixelsLast(40, 30);
  Image decoded;
  ASSERT_EQ(DecodeImage(bytes, decoded), "");
  EXPECT_EQ(decoded.View().At(39, 29), 77);
  ::testing::internal::CaptureStderr();
  for (const std::size_t missing : {1U, 100U, 1000U}) {
    const Bytes part(bytes.begin(), bytes.end() - static_cast<std::ptrdiff_t>(missing));
    EXPECT_NE(DecodeImage(part, decoded), "") << missing;
    EXPECT_TRUE(decoded.empty());
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(DecodeImage, BmpAndJpegTruncated) {
  for (const char* ending : {".bmp", ".jpg"}) {
    Bytes bytes = Encoded(ending, Pattern(CV_8UC1));
    Image decoded;
    EXPECT_EQ(DecodeImage(bytes, decoded), "");
    EXPECT_EQ(decoded.View().width_px, 53);
    bytes.resize(bytes.size() / 2);
    EXPECT_NE(DecodeImage(bytes, decoded), "");
    EXPECT_TRUE(decoded.empty());
  }
}

TEST(DecodeImage, ColourBecomesGrey) {
  Image decoded;
  EXPECT_EQ(DecodeImage(Encoded(".png", cv::Mat(4, 5, CV_8UC3, cv::Scalar(90, 90, 90))), decoded),
            "");
  EXPECT_EQ(decoded.View().type, PixelType::kGray8);
  EXPECT_NEAR(decoded.View().At(2, 2), 90, 1);  // the weights of R, G, B sum to one
}

TEST(DecodeImage, FlippedBitInPng) {
  Bytes bytes = Encoded(".png", Pattern(CV_8UC1));
  bytes[bytes.size() / 2] ^= 4;
  Image decoded;
  EXPECT_EQ(DecodeImage(bytes, decoded), "damaged PNG (check sum)");
  EXPECT_TRUE(decoded.empty());
}

TEST(DecodeImage, NoImageAtAll) {
  Image decoded;
  EXPECT_EQ(DecodeImage({}, decoded), "empty file");
  EXPECT_EQ(DecodeImage({'h', 'e', 'l', 'l', 'o'}, decoded),
            "not a PNG, TIFF, PGM, BMP or JPEG image");
}

TEST(ReadBytes, MissingFileTellsWhy) {
  Bytes bytes;
  EXPECT_EQ(ReadBytes("/nowhere/at/all.png", bytes), "No such file or directory");
}

}  // namespace
}  // namespace stereomotion
