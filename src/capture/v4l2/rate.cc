#include <linux/videodev2.h>

#include <cmath>
#include <cstdio>

#include "format.h"
#include "offers.h"
#include "stereomotion/core/device_error.h"

namespace stereomotion::v4l2 {
namespace {

// Asked 60, got 59.94 (NTSC's 60): the same to a person.
constexpr double kRateTolerance = 0.01;

std::string Hz(double rate_hz) {
  char text[48];  // room for any double with %.4g, and the unit
  std::snprintf(text, sizeof text, "%.4g Hz", rate_hz);
  return text;
}

double RateOf(const v4l2_streamparm& parameters) {
  const v4l2_captureparm& capture = parameters.parm.capture;
  const v4l2_fract& period = capture.timeperframe;
  const bool told = (capture.capability & V4L2_CAP_TIMEPERFRAME) != 0 && period.numerator > 0;
  return told ? static_cast<double>(period.denominator) / period.numerator : 0;
}

}  // namespace

double CurrentRateHz(const Node& node) {
  v4l2_streamparm parameters{};
  parameters.type = node.buffer_type();
  return node.Try(VIDIOC_G_PARM, &parameters) == 0 ? RateOf(parameters) : 0;
}

double AgreeOnRate(const Node& node, const StreamFormat& format, double rate_hz) {
  // The period as a fraction, exact to a millionth of a Hz.
  constexpr double kDenominator = 1e6;
  constexpr double kHighestHz = 4000;  // the fraction must fit 32 bits
  const std::string start = UriOf(node.path()) + ": ";
  if (!(rate_hz > 0) || rate_hz > kHighestHz) {
    throw DeviceError(start + "cannot take " + Hz(rate_hz) + ", expected 0 … " + Hz(kHighestHz));
  }
  v4l2_streamparm parameters{};
  parameters.type = node.buffer_type();
  parameters.parm.capture.timeperframe = {static_cast<__u32>(kDenominator),
                                          static_cast<__u32>(std::lround(rate_hz * kDenominator))};
  node.Call(VIDIOC_S_PARM, &parameters, "set the rate to " + Hz(rate_hz), "VIDIOC_S_PARM");
  const double got_hz = RateOf(parameters);
  if (got_hz <= 0) {
    throw DeviceError(start + "has a rate that cannot be set, asked for were " + Hz(rate_hz) +
                      "; leave it out, or look for a control of the camera for it");
  }
  if (std::abs(got_hz - rate_hz) > kRateTolerance * rate_hz) {
    throw DeviceError(
        start + "was asked for " + Hz(rate_hz) + " and took " + Hz(got_hz) + "; it offers [Hz] " +
        OfferedRates(node, format.fourcc, format.layout.width_px, format.layout.height_px));
  }
  return got_hz;
}

}  // namespace stereomotion::v4l2
