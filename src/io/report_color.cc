#include "report_color.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stereomotion {
namespace {

// A colour by lightness 0 … 1, chroma and hue [deg] of OKLab (Ottosson 2020), in which equal
// distances look equal.
struct OkLch {
  double lightness, chroma, hue_deg;
};

int Byte(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  const double gamma = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;  // sRGB
  return static_cast<int>(std::lround(255 * gamma));
}

std::string Hex(const OkLch& color) {
  const double a = color.chroma * std::cos(color.hue_deg * M_PI / 180);
  const double b = color.chroma * std::sin(color.hue_deg * M_PI / 180);
  const double l = std::pow(color.lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
  const double m = std::pow(color.lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
  const double s = std::pow(color.lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
  return fmt::format("#{:02x}{:02x}{:02x}",
                     Byte(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
                     Byte(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
                     Byte(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s));
}

constexpr double kLightest = 0.97, kDarkest = 0.36;
constexpr double kBlue_deg = 255, kGreenBlue_deg = 195, kOrange_deg = 55;

double Unit(double share) { return std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.0; }

}  // namespace

std::string SequentialColor(double share) {
  const double t = Unit(share);
  return Hex({kLightest + t * (kDarkest - kLightest), 0.02 + 0.10 * t,
              kGreenBlue_deg + t * (kBlue_deg - kGreenBlue_deg)});
}

std::string DivergingColor(double signed_share) {
  const double t = Unit(std::abs(signed_share));
  return Hex({kLightest - 0.45 * t, 0.15 * t, signed_share < 0 ? kBlue_deg : kOrange_deg});
}

std::string TextColorOn(double share) { return Unit(share) > 0.5 ? "#ffffff" : "#222222"; }

}  // namespace stereomotion
