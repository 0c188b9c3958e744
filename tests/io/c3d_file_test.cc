#include "stereomotion/io/c3d_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "c3d_bytes.h"
#include "io_test_support.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::C3dBytes;
using testing::Error;
using testing::Has;
using testing::TextFile;

C3dBytes TwoFrames() {
  C3dBytes bytes;
  bytes.frames = {{{1, 2, 3, 0}, {-4, 5, -6, 1}, {7, 8, 9, 0}},
                  {{1.5F, 2.5F, 3.5F, 0}, {0, 0, 0, -1}, {100, -200, 300, 2}}};
  return bytes;
}

C3dPoints Read(const std::string& bytes) { return ReadC3dBytes(bytes, "markers.c3d"); }

std::string ErrorOf(const std::string& bytes) {
  return Error([&] { Read(bytes); });
}

void ExpectTwoFrames(const C3dPoints& points, double tolerance_mm) {
  EXPECT_EQ(points.labels, (std::vector<std::string>{"A", "B", "C"}));
  EXPECT_EQ(points.rate_hz, 50);
  EXPECT_EQ(points.first_frame, 1);
  ASSERT_EQ(points.points_mm.size(), 2U);
  ASSERT_EQ(points.points_mm[1].size(), 3U);
  EXPECT_NEAR(points.points_mm[0][1].z(), -6, tolerance_mm);
  EXPECT_NEAR(points.points_mm[1][0].x(), 1.5, tolerance_mm);
  EXPECT_NEAR(points.points_mm[1][2].y(), -200, tolerance_mm);
  EXPECT_TRUE(std::isnan(points.points_mm[1][1].x()));
}

TEST(C3dFile, AllByteOrdersAndNumbers) {
  for (const auto processor : {C3dBytes::kIntel, C3dBytes::kDec, C3dBytes::kMips}) {
    for (const bool integers : {false, true}) {
      SCOPED_TRACE(::testing::Message() << "processor " << processor << " integers " << integers);
      C3dBytes bytes = TwoFrames();
      bytes.processor = processor;
      bytes.integers = integers;
      ExpectTwoFrames(Read(bytes.Build()), integers ? bytes.scale : 1e-6);
    }
  }
}

TEST(C3dFile, FromADisk) {
  ExpectTwoFrames(ReadC3d(TextFile("markers.c3d", TwoFrames().Build()).path()), 1e-6);
}

TEST(C3dFile, AnalogDataIsPassedOver) {
  C3dBytes bytes = TwoFrames();
  bytes.analog_per_frame = 5;
  ExpectTwoFrames(Read(bytes.Build()), 1e-6);
}

TEST(C3dFile, UnitsBecomeMillimetres) {
  C3dBytes bytes = TwoFrames();
  bytes.units = "m";
  const C3dPoints points = Read(bytes.Build());
  EXPECT_EQ(points.mm_per_unit, 1000);
  EXPECT_NEAR(points.points_mm[0][0].y(), 2000, 1e-3);
  bytes.units = "furlong";
  EXPECT_TRUE(Has(ErrorOf(bytes.Build()), "POINT:UNITS: found 'furlong', expected mm"));
}

TEST(C3dFile, MoreFramesThanAWordHolds) {
  C3dBytes bytes = TwoFrames();
  bytes.labels = {"A", "B"};
  bytes.long_frames = true;
  constexpr std::size_t kFrames = 70000;
  bytes.frames.assign(kFrames, {{1, 2, 3, 0}, {4, 5, 6, 0}});
  bytes.frames.back()[0][0] = 77;
  const C3dPoints points = Read(bytes.Build());
  ASSERT_EQ(points.points_mm.size(), kFrames);
  EXPECT_EQ(points.points_mm.back()[0].x(), 77);
}

TEST(C3dFile, WhatIsNone) {
  EXPECT_TRUE(Has(ErrorOf(""), "too short"));
  EXPECT_TRUE(Has(ErrorOf(std::string(2000, 'x')), "no C3D or N3D header"));
  C3dBytes bytes = TwoFrames();
  bytes.rate_hz = 0;
  EXPECT_TRUE(Has(ErrorOf(bytes.Build()), "POINT:RATE"));
  EXPECT_TRUE(Has(Error([] { ReadC3d("/nowhere.c3d"); }), "/nowhere.c3d: found no file"));
}

// Cut anywhere, a file is an error that names it, or, within the unused rest of a block, the same.
TEST(C3dFile, CutShort) {
  const std::string whole = TwoFrames().Build();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_TRUE(Has(ErrorOf(whole.substr(0, size)), "markers.c3d")) << size;
  }
}

// Flipped bits give points, maybe wrong ones, or an error; no crash, no endless way.
TEST(C3dFile, FlippedBits) {
  std::mt19937_64 rng = testing::MakeTestRng();
  for (const bool integers : {false, true}) {
    C3dBytes builder = TwoFrames();
    builder.integers = integers;
    const std::string whole = builder.Build();
    for (int run = 0; run < 20000; ++run) {
      std::string bytes = whole;
      for (int flip = 0; flip < 3; ++flip) {
        // Mostly where header and parameters stand.
        const std::size_t area = run % 4 == 0 ? bytes.size() : 700;
        std::size_t at = rng() % std::min(area, bytes.size());
        if (at >= 24 && at < 512) at = rng() % 24;
        bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1U << (rng() % 8)));
      }
      static_cast<void>(ErrorOf(bytes));
    }
  }
}

std::string NdiFile() {
  std::string bytes(256, '\0');
  bytes[0] = 32;
  bytes[1] = 2;  // markers
  bytes[3] = 3;  // numbers each
  bytes[5] = 2;  // frames
  const auto put = [&](float number) {
    char raw[4];
    std::memcpy(raw, &number, 4);
    return std::string(raw, 4);
  };
  bytes.replace(9, 4, put(70));
  for (const float number :
       {1.F, 2.F, 3.F, -3.697314e28F, -3.697314e28F, -3.697314e28F, 4.F, 5.F, 6.F, 7.F, 8.F, 9.F}) {
    bytes += put(number);
  }
  return bytes;
}

TEST(N3dFile, PointsAndGaps) {
  const C3dPoints points = Read(NdiFile());
  EXPECT_EQ(points.rate_hz, 70);
  EXPECT_EQ(points.labels, (std::vector<std::string>{"point1", "point2"}));
  ASSERT_EQ(points.points_mm.size(), 2U);
  EXPECT_EQ(points.points_mm[0][0], Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(std::isnan(points.points_mm[0][1].y()));
  EXPECT_EQ(points.points_mm[1][1], Eigen::Vector3d(7, 8, 9));
}

TEST(N3dFile, CutShort) {
  const std::string whole = NdiFile();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_TRUE(Has(ErrorOf(whole.substr(0, size)), "markers.c3d")) << size;
  }
}

}  // namespace
}  // namespace stereomotion
