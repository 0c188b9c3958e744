#include "live_words.h"

#include <array>
#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>
#include <vector>

#include "stereomotion/core/units.h"

namespace stereomotion {
namespace {

constexpr double kMsPerNs = 1e-6;
/// A constant time difference below this share of a period is not worth a word.
constexpr double kNotableSkew = 1.0 / 16;
/// A body of 1 m/s moves 0.2 mm in it.
constexpr double kNotableJitterNs = 200e3;

std::string Number(double value, int digits) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

std::string Seconds(double seconds) { return Number(seconds, seconds < 10 ? 1 : 0) + " s"; }

std::string Ms(double ns) { return Number(ns * kMsPerNs, 2) + " ms"; }

std::string TimeApart(double ns, double period_ns) {
  return Ms(std::abs(ns)) + " (" + Number(std::abs(ns) / period_ns, 2) + " periods) " +
         (ns < 0 ? "before" : "after");
}

const char* const kTriggerAdvice =
    "trigger both by one line (--trigger hardware), by a command (--trigger software) or by PTP "
    "(--trigger action --ptp); docs/cameras.md";

std::string FreeRunning(const FrameMatcher& matcher, const std::array<std::string, 2>& uris) {
  const MatcherSummary summary = matcher.summary();
  const auto period_ns = static_cast<double>(matcher.clocks().period_ns());
  std::string text = "the cameras free-run against each other: ";
  if (summary.pairs > 0) {
    text += "the images of a pair are up to " + Ms(static_cast<double>(summary.tolerance_ns)) +
            " apart (median " + Ms(summary.skew_ns) + ", spread " + Ms(summary.jitter_ns) +
            "), so a moving body is measured wrong by its way in that time";
  } else {
    text += uris[1] + "'s images lie " + TimeApart(summary.phase_ns, period_ns) + " " + uris[0] +
            "'s: the cameras are not triggered together, so no image has a partner";
  }
  return text + "; " + kTriggerAdvice;
}

std::string Ambiguous(const FrameMatcher& matcher) {
  const auto period_ns = static_cast<double>(matcher.clocks().period_ns());
  return "no pairs at present: the cameras' clocks are not one, and images arrive so irregularly "
         "(by " +
         Ms(matcher.clocks().uncertainty_ns()) + ") that the period of " + Ms(period_ns) +
         " leaves open which belong together; switch on PTP (--ptp), lower the rate, or unload the "
         "network and this computer";
}

std::string Skew(const MatcherSummary& summary, double period_ns,
                 const std::array<std::string, 2>& uris) {
  return uris[1] + "'s images are taken " + TimeApart(summary.skew_ns, period_ns) + " " + uris[0] +
         "'s: set the same trigger delay and exposure in both (what is left is estimated from the "
         "motion: "
         "time_offset_s in motion.json)";
}

void AddCounts(const MatcherSummary& summary, const std::array<std::string, 2>& uris,
               std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < uris.size(); ++i) {
    if (summary.misdated[i] > 0) {
      warnings.push_back(uris[i] + ": " + std::to_string(summary.misdated[i]) +
                         " images carried a time that is not later than the one before; they were "
                         "dropped: does the camera set its timestamps?");
    }
    if (summary.clock_sets[i] > 0) {
      warnings.push_back(uris[i] + ": its clock was set " + std::to_string(summary.clock_sets[i]) +
                         " times while it streamed; pairs were lost each time until it was learned "
                         "anew: wait for PTP to settle before the take");
    }
  }
  if (summary.ambiguous > 0) {
    warnings.push_back(std::to_string(summary.ambiguous) +
                       " times two images were equally near in time to one of the other camera; "
                       "none was taken");
  }
}

std::vector<std::string> PairingWarnings(const FrameMatcher& matcher,
                                         const std::array<std::string, 2>& uris) {
  std::vector<std::string> warnings;
  const MatcherSummary summary = matcher.summary();
  const ClockPair& clocks = matcher.clocks();
  const auto period_ns = static_cast<double>(clocks.period_ns());
  const bool is_skewed = summary.pairs > 0 &&
                         std::abs(summary.skew_ns) > kNotableSkew * period_ns &&
                         std::abs(summary.skew_ns) > 3 * summary.jitter_ns;
  if (clocks.free_running() && period_ns > 0) {
    warnings.push_back(FreeRunning(matcher, uris));
  } else if (is_skewed && clocks.relation() == ClockRelation::kShared) {
    warnings.push_back(Skew(summary, period_ns, uris));
  }
  if (clocks.state() == LockState::kAmbiguous) warnings.push_back(Ambiguous(matcher));
  if (clocks.distrusts_clocks()) {
    warnings.push_back(
        "the cameras say that they have one clock, but their images arrive more than a second "
        "apart by it; the clocks are taken as two: is PTP settled in both?");
  }
  if (summary.given_up > 0 && !clocks.free_running()) {
    warnings.push_back("what was known of the cameras' clocks proved wrong " +
                       std::to_string(summary.given_up) +
                       " times (a clock was set, images came earlier than it allowed, a number was "
                       "left out) and was learned anew before further pairs were taken");
  }
  if (summary.jitter_ns > kNotableJitterNs && !clocks.free_running()) {
    warnings.push_back(
        "the time between the two images of a pair varies by " + Ms(summary.jitter_ns) +
        " (1 sigma): a moving body is measured wrong by its way in that time; trigger "
        "by a line (--trigger hardware)");
  }
  AddCounts(summary, uris, warnings);
  return warnings;
}

}  // namespace

std::string NoImagesText(const std::string& uri, const DeviceCounts& counts, double waited_s) {
  std::string text = uri + ": no whole image within " + Seconds(waited_s);
  if (counts.wrong_format > 0) {
    return text + ", but " + std::to_string(counts.wrong_format) +
           " of another size or pixel format than was agreed on: does another program set the "
           "camera? Switch it off and on again";
  }
  if (counts.incomplete > 0 || counts.underruns > 0) {
    return text + ", but " + std::to_string(counts.incomplete + counts.underruns) +
           " with packets missing: let card and switch carry jumbo frames (MTU 9000) or give "
           "--packet-size 1400, lower the rate; docs/cameras.md";
  }
  return text +
         ": does it wait for a trigger (--trigger free_run shows)? Does a firewall keep its "
         "packets "
         "away, or is a packet size set that the network does not carry (--packet-size 1400 "
         "shows)? "
         "docs/cameras.md";
}

std::string CameraLostText(const std::string& uri, const std::string& why, double waited_s) {
  return uri + ": lost, and not back within " + Seconds(waited_s) + " (--reconnect-s): " + why +
         "; look at cable, power and switch";
}

void DescribePairing(const FrameMatcher& matcher, LiveReport& report) {
  const MatcherSummary summary = matcher.summary();
  const ClockPair& clocks = matcher.clocks();
  for (std::size_t i = 0; i < report.cameras.size(); ++i) {
    report.cameras[i].unpaired = summary.unpaired[i];
  }
  report.pairs = summary.pairs;
  report.period_s = static_cast<double>(clocks.period_ns()) * kSecondsPerNs;
  report.tolerance_ms = static_cast<double>(summary.tolerance_ns) * kMsPerNs;
  report.clock = clocks.relation();
  report.clock_offset_s = -static_cast<double>(clocks.last_offset_ns()) * kSecondsPerNs;
  report.clock_drift_ppm = clocks.drift_ppm();
  report.skew_ms = summary.skew_ns * kMsPerNs;
  report.jitter_ms = summary.jitter_ns * kMsPerNs;
  report.free_running = clocks.free_running();
  const auto warnings = PairingWarnings(matcher, {report.cameras[0].uri, report.cameras[1].uri});
  report.warnings.insert(report.warnings.end(), warnings.begin(), warnings.end());
}

}  // namespace stereomotion
