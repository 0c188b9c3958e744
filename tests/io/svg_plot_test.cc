#include "src/io/svg_plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "src/io/report_color.h"
#include "src/io/report_text.h"

namespace stereomotion {
namespace {

// Lightness L* of CIE 1976 of a colour `#rrggbb`: what the eye sees of it in grey.
double Lightness(const std::string& color) {
  const double weights[] = {0.2126, 0.7152, 0.0722};
  double luminance = 0;
  for (int i = 0; i < 3; ++i) {
    const double byte = std::stoi(color.substr(1 + 2 * i, 2), nullptr, 16) / 255.0;
    luminance +=
        weights[i] * (byte <= 0.04045 ? byte / 12.92 : std::pow((byte + 0.055) / 1.055, 2.4));
  }
  return luminance > 0.008856 ? 116 * std::cbrt(luminance) - 16 : 903.3 * luminance;
}

TEST(ReportColor, LightnessFallsEvenly) {
  const double whole = Lightness(SequentialColor(0)) - Lightness(SequentialColor(1));
  EXPECT_GT(whole, 50);
  for (int i = 0; i < 10; ++i) {
    const double step =
        Lightness(SequentialColor(i / 10.0)) - Lightness(SequentialColor((i + 1) / 10.0));
    EXPECT_GT(step, 0.07 * whole);  // a tenth of it each, nearly
    EXPECT_LT(step, 0.13 * whole);
  }
}

TEST(ReportColor, LettersCanBeRead) {
  for (int i = 0; i <= 20; ++i) {
    const double share = i / 20.0;
    EXPECT_GT(std::abs(Lightness(SequentialColor(share)) - Lightness(TextColorOn(share))), 39)
        << share;  // Tone 40 apart is what Material's guideline asks for contrast 3:1
  }
}

TEST(SvgPlot, TicksAreRoundAndInside) {
  const auto ticks = RoundTicks({-0.5, 1279.5}, 6);
  EXPECT_EQ(ticks, (std::vector<double>{0, 200, 400, 600, 800, 1000, 1200}));
  EXPECT_EQ(RoundTicks({1023.5, -0.5}, 5), (std::vector<double>{0, 200, 400, 600, 800, 1000}));
  EXPECT_TRUE(RoundTicks({3, 3}, 5).empty());
  EXPECT_TRUE(RoundTicks({0, std::numeric_limits<double>::quiet_NaN()}, 5).empty());
}

TEST(SvgPlot, AxesMapTheirEnds) {
  const Axes image({-0.5, 1279.5}, {1023.5, -0.5}, {60, 10, 480, 384});
  EXPECT_DOUBLE_EQ(image.X(-0.5), 60);
  EXPECT_DOUBLE_EQ(image.X(1279.5), 540);
  EXPECT_DOUBLE_EQ(image.Y(-0.5), 10);  // v points down
  EXPECT_DOUBLE_EQ(image.Y(1023.5), 394);
}

TEST(ReportText, Numbers) {
  EXPECT_EQ(Digits(0.012345, 3), "0.0123");
  EXPECT_EQ(Digits(1234.5, 3), "1234");
  EXPECT_EQ(Digits(2.0, 2), "2.0");
  EXPECT_EQ(Digits(0, 3), "0");
  EXPECT_EQ(Digits(1.234e-9, 2), "1.2e-09");
  EXPECT_EQ(Digits(std::numeric_limits<double>::infinity(), 3), "–");
  EXPECT_EQ(ValueText(1643.4219, 0.2731), "1643.42");
  EXPECT_EQ(ValueText(-0.07031234, 0.00031), "-0.07031");
  EXPECT_EQ(ValueText(1643.4219, 0), "1643.42");
  EXPECT_EQ(ValueText(1643.4219, 250), "1643");
  EXPECT_EQ(ValueText(-0.0004, 0.1), "0.00");
}

}  // namespace
}  // namespace stereomotion
