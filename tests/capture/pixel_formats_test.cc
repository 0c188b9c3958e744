#include "src/capture/pixel_formats.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <vector>

namespace stereomotion {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::string Convert(const Bytes& bytes, PixelFormat format, int width_px, int height_px,
                    Image& image, std::ptrdiff_t stride_bytes = 0) {
  return ConvertToGrey(bytes.data(), format, {width_px, height_px, stride_bytes, bytes.size()},
                       image);
}

// The grey values of an image that must convert, row by row.
std::vector<int> Grey(const Bytes& bytes, PixelFormat format, int width_px, int height_px,
                      std::ptrdiff_t stride_bytes = 0) {
  Image image;
  EXPECT_EQ(Convert(bytes, format, width_px, height_px, image, stride_bytes), "");
  const ImageView view = image.View();
  EXPECT_EQ(view.type, GreyBits(format) == 8 ? PixelType::kGray8 : PixelType::kGray16);
  std::vector<int> values;
  for (int v = 0; v < view.height_px; ++v) {
    for (int u = 0; u < view.width_px; ++u) values.push_back(static_cast<int>(view.At(u, v)));
  }
  return values;
}

using Values = std::vector<int>;

TEST(PixelFormats, EightBitsStayAsTheyAre) {
  EXPECT_EQ(Grey({0, 1, 254, 255}, PixelFormat::kGrey8, 2, 2), (Values{0, 1, 254, 255}));
}

TEST(PixelFormats, SixteenBitsAreLittleEndianAndNotScaled) {
  const Bytes bytes{0xFF, 0x03, 0x01, 0x00, 0x34, 0x12, 0xFF, 0xFF};
  for (const PixelFormat format :
       {PixelFormat::kGrey10, PixelFormat::kGrey12, PixelFormat::kGrey14, PixelFormat::kGrey16}) {
    EXPECT_EQ(Grey(bytes, format, 2, 2), (Values{1023, 1, 0x1234, 0xFFFF}));
  }
}

// A stream of bits, least significant first: written here bit by bit.
Bytes PackBits(const Values& values, int bits) {
  Bytes bytes((values.size() * static_cast<std::size_t>(bits) + 7) / 8);
  std::size_t at = 0;
  for (const int value : values) {
    for (int bit = 0; bit < bits; ++bit, ++at) {
      bytes[at / 8] = static_cast<std::uint8_t>(bytes[at / 8] | (value >> bit & 1) << at % 8);
    }
  }
  return bytes;
}

TEST(PixelFormats, PfncPackedIsAStreamOfBits) {
  const Values ten{0, 1, 512, 1023, 0x155, 0x2AA, 3, 768};
  EXPECT_EQ(Grey(PackBits(ten, 10), PixelFormat::kGrey10p, 4, 2), ten);
  const Values twelve{0, 4095, 1, 2048, 0x555, 0xAAA, 0x123, 0xFED};
  EXPECT_EQ(Grey(PackBits(twelve, 12), PixelFormat::kGrey12p, 4, 2), twelve);
}

TEST(PixelFormats, GigeVisionPackedHasLowBitsInTheMiddle) {
  // 0x2AB and 0x155: high 8 bits, then low 2 bits of the first at 0–1 and of the second at 4–5.
  EXPECT_EQ(Grey({0xAA, 0x13, 0x55}, PixelFormat::kGrey10Packed, 2, 1), (Values{0x2AB, 0x155}));
  // 0xABC and 0x123: high 8 bits, low nibbles 0xC and 0x3, high 8 bits.
  EXPECT_EQ(Grey({0xAB, 0x3C, 0x12}, PixelFormat::kGrey12Packed, 2, 1), (Values{0xABC, 0x123}));
}

TEST(PixelFormats, BayerOfOneColourIsItsLuminanceEverywhere) {
  constexpr int kRed = 200;
  constexpr int kGreen = 100;
  constexpr int kBlue = 20;
  constexpr int kSide = 6;
  for (int shift = 0; shift < 4; ++shift) {  // the four patterns
    Bytes bytes;
    for (int v = 0; v < kSide; ++v) {
      for (int u = 0; u < kSide; ++u) {
        const int odd = (u + shift % 2) % 2 + (v + shift / 2) % 2;
        const bool red = (u + shift % 2) % 2 == 0 && odd == 0;
        bytes.push_back(static_cast<std::uint8_t>(odd == 1 ? kGreen : red ? kRed : kBlue));
      }
    }
    const Values expected(kSide * kSide, (kRed + 2 * kGreen + kBlue + 2) / 4);
    EXPECT_EQ(Grey(bytes, PixelFormat::kBayer8, kSide, kSide), expected) << shift;
  }
}

TEST(PixelFormats, BayerSpreadsAPointSymmetrically) {
  Bytes bytes(25, 0);
  bytes[12] = 160;
  const Values expected{0,  0, 0, 0,  0,  0,  10, 20, 10, 0, 0, 20, 40,
                        20, 0, 0, 10, 20, 10, 0,  0,  0,  0, 0, 0};
  EXPECT_EQ(Grey(bytes, PixelFormat::kBayer8, 5, 5), expected);
}

TEST(PixelFormats, DeepBayerKeepsItsRange) {
  EXPECT_EQ(Grey(PackBits(Values(16, 4095), 12), PixelFormat::kBayer12p, 4, 4), Values(16, 4095));
  EXPECT_EQ(Grey(PackBits(Values(16, 1023), 10), PixelFormat::kBayer10p, 4, 4), Values(16, 1023));
  EXPECT_EQ(Grey(Bytes(24, 0xFF), PixelFormat::kBayer12Packed, 4, 4), Values(16, 4095));
  EXPECT_EQ(Grey(Bytes(24, 0xFF), PixelFormat::kBayer10Packed, 4, 4), Values(16, 1023));
  EXPECT_EQ(Grey(Bytes(32, 0xFF), PixelFormat::kBayer16, 4, 4), Values(16, 65535));
}

TEST(PixelFormats, ColoursBecomeLuminance) {
  const Bytes bytes{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};
  EXPECT_EQ(Grey(bytes, PixelFormat::kRgb8, 4, 1), (Values{76, 150, 29, 255}));
  EXPECT_EQ(Grey(bytes, PixelFormat::kBgr8, 4, 1), (Values{29, 150, 76, 255}));
}

TEST(PixelFormats, YuvGivesItsY) {
  EXPECT_EQ(Grey({16, 1, 235, 2}, PixelFormat::kYuyv, 2, 1), (Values{16, 235}));
  EXPECT_EQ(Grey({1, 16, 2, 235}, PixelFormat::kUyvy, 2, 1), (Values{16, 235}));
  EXPECT_EQ(Grey({1, 2, 3, 4, 128, 128}, PixelFormat::kNv12, 2, 2), (Values{1, 2, 3, 4}));
}

TEST(PixelFormats, PaddedRows) {
  EXPECT_EQ(Grey({1, 2, 99, 3, 4}, PixelFormat::kGrey8, 2, 2, 3), (Values{1, 2, 3, 4}));
  EXPECT_EQ(Grey({1, 2, 99, 3, 4, 99, 128, 128}, PixelFormat::kNv12, 2, 2, 3),
            (Values{1, 2, 3, 4}));
}

TEST(PixelFormats, JpegIsDecodedAndATornOneRefused) {
  cv::Mat flat(16, 24, CV_8UC1, cv::Scalar(120));
  Bytes bytes;
  cv::imencode(".jpg", flat, bytes);
  for (const int value : Grey(bytes, PixelFormat::kMjpg, 24, 16)) EXPECT_NEAR(value, 120, 2);
  Image image;
  EXPECT_NE(Convert(bytes, PixelFormat::kMjpg, 24, 24, image), "") << "another size";
  bytes.resize(bytes.size() - 10);
  EXPECT_NE(Convert(bytes, PixelFormat::kMjpg, 24, 16, image), "");
  EXPECT_TRUE(image.empty());
  EXPECT_NE(Convert({1, 2, 3}, PixelFormat::kMjpg, 24, 16, image), "");
}

TEST(PixelFormats, OneByteTooFewIsRefusedInEveryFormat) {
  constexpr int kWidth = 8;
  constexpr int kHeight = 4;
  for (auto i = static_cast<int>(PixelFormat::kGrey8); i < static_cast<int>(PixelFormat::kMjpg);
       ++i) {
    const auto format = static_cast<PixelFormat>(i);
    Bytes bytes(BytesOfImage(format, kWidth, kHeight));
    ASSERT_GE(bytes.size(), 32U);
    Image image;
    EXPECT_EQ(Convert(bytes, format, kWidth, kHeight, image), "") << i;
    const std::string needed = std::to_string(bytes.size());
    bytes.pop_back();
    const std::string why = Convert(bytes, format, kWidth, kHeight, image);
    EXPECT_NE(why.find("fewer than the " + needed + " bytes"), std::string::npos) << why;
    EXPECT_TRUE(image.empty()) << i;
  }
}

TEST(PixelFormats, SizesThatCannotBeAreRefused) {
  Image image;
  const Bytes bytes(64);
  EXPECT_NE(Convert(bytes, PixelFormat::kGrey8, 0, 4, image), "");
  EXPECT_NE(Convert(bytes, PixelFormat::kGrey8, 4, -1, image), "");
  EXPECT_NE(Convert(bytes, PixelFormat::kBayer8, 1, 4, image), "");
  EXPECT_NE(Convert(bytes, PixelFormat::kGrey10p, 6, 4, image), "") << "no multiple of 4";
  EXPECT_NE(Convert(bytes, PixelFormat::kGrey12p, 3, 2, image), "") << "odd";
  EXPECT_NE(Convert(bytes, PixelFormat::kGrey16, 4, 4, image, 6), "") << "rows too short";
  EXPECT_NE(Convert(bytes, PixelFormat::kUnknown, 4, 4, image), "");
}

TEST(PixelFormats, NamesAndCodes) {
  EXPECT_EQ(PixelFormatFromName("Mono8"), PixelFormat::kGrey8);
  EXPECT_EQ(PixelFormatFromName("Mono12Packed"), PixelFormat::kGrey12Packed);
  for (const char* name : {"BayerRG12p", "BayerGR12p", "BayerGB12p", "BayerBG12p"}) {
    EXPECT_EQ(PixelFormatFromName(name), PixelFormat::kBayer12p);
  }
  EXPECT_EQ(PixelFormatFromName("Coord3D_ABC32f"), PixelFormat::kUnknown);
  EXPECT_EQ(PixelFormatFromPfnc(0x01080001), PixelFormat::kGrey8);
  EXPECT_EQ(PixelFormatFromPfnc(0x0108000B), PixelFormat::kBayer8);
  EXPECT_EQ(PixelFormatFromPfnc(0x010A0058), PixelFormat::kBayer10p);
  EXPECT_EQ(PixelFormatFromPfnc(0x010A0053), PixelFormat::kUnknown);
  EXPECT_EQ(PixelFormatFromPfnc(0), PixelFormat::kUnknown);
}

}  // namespace
}  // namespace stereomotion
