#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "check_findings.h"

namespace stereomotion::app {
namespace {

constexpr double kPercent = 100;
/// Losses that a take survives: a gap of a frame is bridged by the tracker, many are not.
constexpr double kFewLost = 0.001, kManyLost = 0.05;

double Share(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

Finding JudgeRate(const StreamFacts& stream) {
  Finding finding{"rate", "", Verdict::kGood, "", "", {}};
  const double rate_hz = stream.period_s > 0 ? 1 / stream.period_s : 0;
  finding.values = {{"rate_hz", rate_hz}, {"pairs", static_cast<double>(stream.pairs)}};
  finding.text = fmt::format("{} pairs", stream.pairs);
  if (rate_hz > 0) finding.text += fmt::format(", {:.4g} a second", rate_hz);
  double worst = 0;
  for (const std::size_t side : {0, 1}) {
    const std::int64_t missing = stream.incomplete[side] + stream.lost[side];
    const double share = Share(missing, stream.frames[side] + missing);
    worst = std::max(worst, share);
    if (missing == 0) continue;
    finding.text +=
        fmt::format("; {}: {} images incomplete, {} lost ({:.2g} %)", stream.names[side],
                    stream.incomplete[side], stream.lost[side], kPercent * share);
  }
  finding.values["missing_share"] = worst;
  if (worst > kFewLost) {
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

Finding JudgeSync(const StreamFacts& stream) {
  Finding finding{"sync", "", Verdict::kGood, "", "", {}};
  const std::int64_t unpaired = std::max(stream.unpaired[0], stream.unpaired[1]);
  const double share = Share(unpaired, stream.pairs + unpaired);
  finding.values = {
      {"skew_ms", stream.skew_ms}, {"jitter_ms", stream.jitter_ms}, {"unpaired_share", share}};
  finding.text = fmt::format(
      "right − left {:.3f} ms ± {:.3f} ms in the pairs; without partner {} "
      "left, {} right",
      stream.skew_ms, stream.jitter_ms, stream.unpaired[0], stream.unpaired[1]);
  if (!stream.timed) {
    finding.verdict = Verdict::kMind;
    finding.text = "the images carry no times: paired by number, nothing tells whether in step";
    finding.advice = "record with `stereomotion record`, or write timestamps.csv";
  } else if (stream.free_running) {
    finding.verdict = Verdict::kMend;
    finding.text = "the cameras run freely, each at its own rate: " + finding.text;
    finding.advice = kTriggerThem;
  } else if (stream.pairs == 0 || share > kManyLost) {
    finding.verdict = Verdict::kMend;
    finding.advice = std::string("images of one camera have no partner: ") + kTriggerThem;
  } else if (share > kFewLost) {
    finding.verdict = Verdict::kMind;
    finding.advice = "some images have no partner: see what the rate says of lost ones";
  }
  return finding;
}

}  // namespace

std::vector<Finding> JudgeStream(const StreamFacts& stream) {
  std::vector<Finding> findings = {JudgeRate(stream), JudgeSync(stream)};
  for (const std::string& warning : stream.warnings) {
    findings.push_back({"camera", "", Verdict::kMind, warning, "", {}});
  }
  return findings;
}

}  // namespace stereomotion::app
