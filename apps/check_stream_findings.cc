#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "check_findings.h"

namespace stereomotion::app {
namespace {

constexpr double kPercent = 100;
/// Losses that a take survives: a gap of a frame is bridged by the tracker, many are not.
constexpr double kFewLost = 0.001, kManyLost = 0.05;
/// Images without partner that a look at live cameras may have at its ends: of a short one a large
/// share.
constexpr std::int64_t kAtTheEnds = 2;

double Share(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

// Tells what is missing of both cameras; returns the larger share of them.
double TellMissing(const StreamFacts& stream, std::string& text) {
  double worst = 0;
  for (const std::size_t side : {0, 1}) {
    const std::int64_t missing = stream.incomplete[side] + stream.lost[side];
    const double share = Share(missing, stream.frames[side] + missing);
    worst = std::max(worst, share);
    if (missing == 0) continue;
    text += fmt::format("; {}: {} images incomplete, {} lost ({:.2g} %)", stream.names[side],
                        stream.incomplete[side], stream.lost[side], kPercent * share);
  }
  return worst;
}

Finding JudgeRate(const StreamFacts& stream) {
  Finding finding{"rate", "", Verdict::kGood, "", "", {}};
  const double rate_hz = stream.period_s > 0 ? 1 / stream.period_s : 0;
  finding.text = fmt::format("{} pairs", stream.pairs);
  if (rate_hz > 0) finding.text += fmt::format(", {:.4g} a second", rate_hz);
  const double worst = TellMissing(stream, finding.text);
  finding.values = {
      {"rate_hz", rate_hz}, {"pairs", static_cast<double>(stream.pairs)}, {"missing_share", worst}};
  if (stream.pairs == 0) {
    finding.verdict = Verdict::kMend;
    finding.advice = "no image of one camera goes with one of the other: see sync";
  } else if (worst > kFewLost) {
    finding.verdict = worst > kManyLost ? Verdict::kMend : Verdict::kMind;
    finding.advice =
        "the network, the USB port or the computer does not keep up: raise net.core.rmem_max, use "
        "jumbo frames (MTU 9000), a network card a camera, a lower rate or a smaller region "
        "(docs/cameras.md, Network)";
  }
  return finding;
}

constexpr const char* kTriggerThem =
    "trigger both cameras by one line (--trigger hardware), or let them share a clock (--ptp); "
    "cameras that run freely measure a moving body at two different times (docs/cameras.md, "
    "Synchronisation)";

constexpr const char* kSilent =
    "the camera fell silent: look at its cable, its power and the network, then check again";

// Images that never came are in no count: a camera without connection loses none.
std::vector<Finding> JudgeSilence(const StreamFacts& stream) {
  constexpr double kLateStart_s = 0.5, kFewPeriods = 2;
  std::vector<Finding> findings;
  for (const std::size_t side : {0, 1}) {
    const double rate_hz =
        stream.rate_hz[side] > 0 ? stream.rate_hz[side] : stream.rate_hz[1 - side];
    if (!stream.live || !(rate_hz > 0)) continue;
    const double expected = stream.watched_s * rate_hz;
    const double silent_s = stream.watched_s - static_cast<double>(stream.frames[side]) / rate_hz;
    const double down_s = stream.down_s[side];
    if (down_s <= 0 && silent_s <= std::max(kLateStart_s, kFewPeriods / rate_hz)) continue;
    std::string text = fmt::format("{} images", stream.frames[side]);
    if (expected > 0)
      text += fmt::format(" in {:.3g} s, expected {:.0f}", stream.watched_s, expected);
    if (down_s > 0) text += fmt::format("; {:.1f} s without connection", down_s);
    findings.push_back({"rate",
                        stream.names[side],
                        Verdict::kMend,
                        text,
                        kSilent,
                        {{"silent_s", std::max(silent_s, down_s)}, {"down_s", down_s}}});
  }
  return findings;
}

// Triggered cameras take their images together; what has no partner then was lost.
bool IsOutOfStep(const StreamFacts& stream) {
  constexpr double kMsPerSecond = 1e3, kManyPeriods = 0.05;
  if (stream.pairs == 0 || !(stream.period_s > 0)) return true;
  const double largest_ms = std::max(std::abs(stream.skew_ms), stream.jitter_ms);
  return largest_ms > kManyPeriods * kMsPerSecond * stream.period_s;
}

std::string AdviceForUnpaired(const StreamFacts& stream) {
  if (stream.frames[0] == 0 || stream.frames[1] == 0) return "one camera sent no image: see rate";
  if (IsOutOfStep(stream))
    return std::string("images of one camera have no partner: ") + kTriggerThem;
  return "images of one camera are missing, those that came are in step: see what the rate says of "
         "lost ones";
}

std::string SyncText(const StreamFacts& stream) {
  return fmt::format(
      "right − left {:.3f} ms ± {:.3f} ms in the pairs; without partner {} left, {} right",
      stream.skew_ms, stream.jitter_ms, stream.unpaired[0], stream.unpaired[1]);
}

Finding JudgeSync(const StreamFacts& stream) {
  Finding finding{"sync", "", Verdict::kGood, "", "", {}};
  const std::int64_t unpaired = std::max(stream.unpaired[0], stream.unpaired[1]);
  const double share = Share(unpaired, stream.pairs + unpaired);
  const std::int64_t at_ends = stream.live ? kAtTheEnds : 0;
  finding.values = {
      {"skew_ms", stream.skew_ms}, {"jitter_ms", stream.jitter_ms}, {"unpaired_share", share}};
  finding.text = SyncText(stream);
  if (!stream.timed) {
    finding.verdict = Verdict::kMind;
    finding.text = "the images carry no times: paired by number, nothing tells whether in step";
    finding.advice = "record with `stereomotion record`, or write timestamps.csv";
  } else if (stream.free_running) {
    finding.verdict = Verdict::kMend;
    finding.text = "the cameras run freely, each at its own rate: " + finding.text;
    finding.advice = kTriggerThem;
  } else if (stream.pairs == 0 || (share > kManyLost && unpaired > at_ends)) {
    finding.verdict = Verdict::kMend;
    finding.advice = AdviceForUnpaired(stream);
  } else if (share > kFewLost) {
    finding.verdict = Verdict::kMind;
    finding.advice = "some images have no partner: see what the rate says of lost ones";
  }
  return finding;
}

}  // namespace

std::vector<Finding> JudgeStream(const StreamFacts& stream) {
  std::vector<Finding> findings = {JudgeRate(stream), JudgeSync(stream)};
  for (Finding& finding : JudgeSilence(stream)) findings.push_back(std::move(finding));
  for (const std::string& warning : stream.warnings) {
    findings.push_back({"camera", "", Verdict::kMind, warning, "", {}});
  }
  return findings;
}

}  // namespace stereomotion::app
