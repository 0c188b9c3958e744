#include "tests/support/gv_plan.h"

#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>

namespace stereomotion::testing {
namespace {

using Setter = std::function<void(GvPlan&, const std::string&)>;

template <class T>
Setter Number(T GvPlan::*member) {
  return [member](GvPlan& plan, const std::string& text) {
    plan.*member = static_cast<T>(std::stod(text));
  };
}

Setter Text(std::string GvPlan::*member) {
  return [member](GvPlan& plan, const std::string& text) { plan.*member = text; };
}

void SetSize(GvPlan& plan, const std::string& text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string::npos) throw std::invalid_argument("--size is WIDTHxHEIGHT");
  plan.width_px = std::stoi(text);
  plan.height_px = std::stoi(text.substr(cross + 1));
}

const std::map<std::string, Setter>& Setters() {
  static const std::map<std::string, Setter> setters{
      {"--recording", Text(&GvPlan::recording)},
      {"--camera", Text(&GvPlan::camera)},
      {"--address", Text(&GvPlan::address)},
      {"--serial", Text(&GvPlan::serial)},
      {"--rate", Number(&GvPlan::rate_hz)},
      {"--rate-factor", Number(&GvPlan::rate_factor)},
      {"--clock-offset-s", Number(&GvPlan::clock_offset_s)},
      {"--clock-drift-ppm", Number(&GvPlan::clock_drift_ppm)},
      {"--lost-per-mille", Number(&GvPlan::lost_per_mille)},
      {"--first-id", Number(&GvPlan::first_id)},
      {"--frames", Number(&GvPlan::frames)},
      {"--change-format-after", Number(&GvPlan::change_format_after)},
      {"--pixel-format", Text(&GvPlan::pixel_format)},
      {"--exposure-us", Number(&GvPlan::exposure_us)},
      {"--size", SetSize},
      {"--images", Number(&GvPlan::images)},
      {"--packet-bytes", Number(&GvPlan::packet_bytes)},
  };
  return setters;
}

bool SetFlag(GvPlan& plan, const std::string& name) {
  if (name == "--clock-from-start") return plan.clock_from_start = true;
  if (name == "--ids-with-zero") return plan.ids_with_zero = true;
  if (name == "--stamp") return plan.stamp = true;
  return false;
}

/// Goes through the arguments; those before the first --camera are of all cameras.
class Parser {
 public:
  void Take(const std::string& name, const std::function<std::string()>& value) {
    if (name == "--stop-after") {
      server_.stop_after_s = std::stod(value());
    } else if (name == "--seed") {
      server_.seed = static_cast<std::uint32_t>(std::stoul(value()));
    } else if (name == "--camera") {
      server_.cameras.push_back(common_);
      server_.cameras.back().camera = value();
    } else if (GvPlan& plan = server_.cameras.empty() ? common_ : server_.cameras.back();
               !SetFlag(plan, name)) {
      const auto setter = Setters().find(name);
      if (setter == Setters().end()) throw std::invalid_argument("unknown option " + name);
      setter->second(plan, value());
    }
  }
  GvServerPlan Finish() {
    if (server_.cameras.empty()) throw std::invalid_argument("no --camera given");
    for (GvPlan& plan : server_.cameras) {
      if (plan.serial.empty()) plan.serial = plan.camera;
    }
    return server_;
  }

 private:
  GvPlan common_;
  GvServerPlan server_;
};

}  // namespace

GvServerPlan ParseGvServerArguments(const std::vector<std::string>& arguments) {
  Parser parser;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string name = arguments[i];
    parser.Take(name, [&] {
      if (i + 1 == arguments.size()) throw std::invalid_argument(name + " needs a value");
      return arguments[++i];
    });
  }
  return parser.Finish();
}

std::int64_t GvPeriodUs(double rate_hz) { return std::llround(1e6 / rate_hz); }

std::int64_t GvDeviceNs(const GvPlan& plan, std::int64_t true_us, std::int64_t started_us) {
  const std::int64_t zero_us = plan.clock_from_start ? started_us : kGvClockZero_us;
  const std::int64_t since_ns = (true_us - zero_us) * 1000;
  const double drift_ns = static_cast<double>(since_ns) * plan.clock_drift_ppm * 1e-6;
  return since_ns + std::llround(drift_ns) + std::llround(plan.clock_offset_s * 1e9);
}

int GvImageAt(const GvPlan& plan, std::int64_t true_us, int images) {
  if (images < 2) return 0;
  const std::int64_t period_us = GvPeriodUs(plan.rate_hz);
  const std::int64_t step = (true_us + period_us / 2) / period_us;
  const std::int64_t turn = 2 * (std::int64_t{images} - 1);
  const std::int64_t place = step % turn;
  return static_cast<int>(place < images ? place : turn - place);
}

std::uint16_t GvFrameId(const GvPlan& plan, std::int64_t count) {
  constexpr std::int64_t kIds = 65535;  // GigE Vision 1: 0 is no frame
  const std::int64_t id = plan.ids_with_zero ? (plan.first_id + count) % (kIds + 1)
                                             : (plan.first_id - 1 + count) % kIds + 1;
  return static_cast<std::uint16_t>(id);
}

}  // namespace stereomotion::testing
