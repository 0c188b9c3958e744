#include <fmt/format.h>

#include <algorithm>

#include "check_findings.h"

namespace stereomotion::app {
namespace {

constexpr double kPercent = 100;

// All thresholds: docs/accuracy.md, "Light" and "Diameter". A centre of 9 px is known to 0.09 px at
// 15 dB, 0.03 px at 25 dB, 0.01 px at 40 dB; below 10 dB balls are no longer found.
constexpr double kDark_db = 15, kDim_db = 25;
/// Grey values: below, rounding is no noise any more, and residuals grow.
constexpr double kDark_dn = 8;
/// An 8-bit image whose balls reach less of its range than that wastes light: quantisation counts.
constexpr double kDimPeak = 0.2;
/// Saturated pixels tell only that they are bright. The limb, which tells the centre, goes with
/// them when most of the ball is saturated.
constexpr double kSaturatedSome = 0.1, kSaturatedMost = 0.5;
/// The rest of the range must hold the ball.
constexpr double kBrightBackground = 0.3;
/// Standard deviation of the blur: a sharp lens gives 0.5 to 0.8 px. The centre's σ grows as the
/// root of it: by 1.4 at 1.2 px, by 2 at 2.5 px, where small balls run into one another.
constexpr double kSoft_px = 1.2, kBlurred_px = 2.5;
/// docs/accuracy.md, "Smear": half a diameter costs a quarter more error, a whole one 60 %; beyond
/// a half the faster detectors fail.
constexpr double kSmearOfDiameter = 0.5;
/// The detector is tested from 6 px on (0.024 px at 30 dB against 0.020 at 9 px) and takes nothing
/// below 3 px or above 64 px.
constexpr double kTiny_px = 4, kSmall_px = 6, kLarge_px = 50;
/// Two rods with three balls seen are what a pose from nothing needs.
constexpr double kFewBalls = 6;
constexpr double kAnyBall = 0.5;  // a median of 0.5 or more: seen in half of the images

constexpr const char* kTooBright =
    "too bright: shorter exposure (--exposure-us; it also smears less), less gain, smaller "
    "aperture";

Finding JudgeBalls(const CameraLook& look) {
  Finding finding{"balls", look.name, Verdict::kGood, "", "", {{"balls", look.balls}}};
  finding.text = fmt::format("{:.0f} whole balls an image, in {} images", look.balls, look.images);
  if (look.images == 0) {
    finding.verdict = Verdict::kMend;
    finding.text = "no image came";
    finding.advice = "see the messages about the camera";
  } else if (look.balls < kAnyBall) {
    finding.verdict = Verdict::kMend;
    finding.text = fmt::format(
        "no ball seen in {} images; the brightest pixel has {:.0f} % of the "
        "full grey value",
        look.images, kPercent * look.brightest_share);
    if (look.blobs >= kAnyBall) {
      finding.text += fmt::format("; {:.0f} bright blobs an image, none a whole ball", look.blobs);
    }
    finding.advice =
        look.blobs >= kAnyBall && look.saturated_share >= kSaturatedMost ? kTooBright
        : look.brightest_share < kDimPeak
            ? "it is dark: lens cap, lamp, aperture, exposure time (--exposure-us), gain"
            : "is the body in view, is the lens in focus, does light come from beside the lens? "
              "Balls are round, at least 3 px wide, and brighter than what is around them";
  } else if (look.balls < kFewBalls) {
    finding.verdict = Verdict::kMind;
    finding.advice =
        "a pose from nothing needs two rods with three balls each, seen by both cameras";
  }
  return finding;
}

Finding JudgeExposure(const CameraLook& look) {
  Finding finding{"exposure", look.name, Verdict::kGood, "", "", {}};
  finding.values = {{"peak_share", look.peak_share},
                    {"saturated_share", look.saturated_share},
                    {"snr_db", look.snr_db}};
  finding.text = fmt::format(
      "balls at {:.0f} % of the full grey value, {:.0f} dB over the noise, "
      "{:.0f} % of their pixels saturated",
      kPercent * look.peak_share, look.snr_db, kPercent * look.saturated_share);
  if (look.saturated_share >= kSaturatedSome) {
    const bool most = look.saturated_share >= kSaturatedMost;
    finding.verdict = most ? Verdict::kMend : Verdict::kMind;
    finding.advice = kTooBright;
  } else if (look.snr_db < kDim_db || look.peak_share < kDimPeak) {
    const bool dark = look.snr_db < kDark_db || look.amplitude_dn < kDark_dn;
    finding.verdict = dark ? Verdict::kMend : Verdict::kMind;
    finding.advice =
        "too dark: more light beside the lens, wider aperture, longer exposure "
        "(--exposure-us) as far as the motion allows; gain (--gain-db) comes last, it "
        "makes the noise brighter, too";
  }
  return finding;
}

Finding JudgeBackground(const CameraLook& look) {
  Finding finding{"background", look.name, Verdict::kGood, "", "", {}};
  finding.values = {{"background_share", look.background_share}};
  finding.text = fmt::format("{:.0f} % of the full grey value beside the balls",
                             kPercent * look.background_share);
  if (look.background_share > kBrightBackground) {
    finding.verdict = Verdict::kMind;
    finding.advice =
        "darken what is behind the body, or use a filter for the lamp's colour and a "
        "shorter exposure: the balls' own light comes back to the lens, other light "
        "does not";
  }
  return finding;
}

Finding JudgeFocus(const CameraLook& look) {
  Finding finding{"focus", look.name, Verdict::kGood, "", "", {{"blur_px", look.blur_px}}};
  finding.text = fmt::format("edges blurred by {:.2f} px", look.blur_px);
  if (look.blur_px > kSoft_px) {
    finding.verdict = look.blur_px > kBlurred_px ? Verdict::kMend : Verdict::kMind;
    finding.advice =
        "focus the lens on the middle of the volume (then calibrate anew), close the "
        "aperture for more depth";
  }
  return finding;
}

Finding JudgeSmear(const CameraLook& look) {
  Finding finding{"smear", look.name, Verdict::kGood, "", "", {{"smear_px", look.smear_px}}};
  finding.text = look.smear_px > 0
                     ? fmt::format("balls move by {:.1f} px in the exposure", look.smear_px)
                     : "no smear from motion";
  if (look.smear_px > kSmearOfDiameter * look.diameter_px) {
    finding.verdict = Verdict::kMind;
    finding.advice = "shorter exposure (--exposure-us) and more light";
  }
  return finding;
}

Finding JudgeSize(const CameraLook& look) {
  Finding finding{"size", look.name, Verdict::kGood, "", "", {{"diameter_px", look.diameter_px}}};
  finding.text = fmt::format("balls are {:.1f} px wide", look.diameter_px);
  if (look.diameter_px < kSmall_px) {
    finding.verdict = look.diameter_px < kTiny_px ? Verdict::kMend : Verdict::kMind;
    finding.advice = "larger balls, a longer lens, or nearer cameras: 8 to 15 px are best";
  } else if (look.diameter_px > kLarge_px) {
    finding.verdict = Verdict::kMind;
    finding.advice = "balls wider than 64 px are not found: smaller ones, or a shorter lens";
  }
  return finding;
}

Finding JudgeCoverage(const CameraLook& look) {
  constexpr double kOftenClipped = 0.5;
  Finding finding{"coverage", look.name, Verdict::kGood, "", "", {}};
  finding.values = {{"area_share", look.area_share}, {"clipped", look.clipped}};
  const auto& lower = look.seen_px.min();
  const auto& upper = look.seen_px.max();
  finding.text = fmt::format(
      "balls seen at u {:.0f} to {:.0f}, v {:.0f} to {:.0f} of {} x {} px "
      "({:.0f} % of the image)",
      lower.x(), upper.x(), lower.y(), upper.y(), look.width_px, look.height_px,
      kPercent * look.area_share);
  if (look.clipped > kOftenClipped) {
    finding.verdict = Verdict::kMind;
    finding.text += fmt::format("; {:.1f} an image cut by its border", look.clipped);
    finding.advice = "the body leaves the view, or something bright lies at its border";
  }
  return finding;
}

Finding DescribeNoise(const CameraLook& look) {
  Finding finding{"noise", look.name, Verdict::kGood, "", "", {}};
  const SensorNoise& noise = look.noise.noise;
  finding.values = {{"gain_e_per_dn", noise.gain_e_per_dn},
                    {"read_e", noise.read_e},
                    {"saturation_dn", noise.saturation_dn}};
  if (look.noise.origin == "default") {
    finding.verdict = Verdict::kMind;
    finding.text = "the noise could not be learned";
    finding.advice = "show balls, or give `noise:` in rig.yaml: else covariances are only rough";
    return finding;
  }
  finding.text = fmt::format("{:.3g} electrons a grey value, {:.3g} electrons read noise ({})",
                             noise.gain_e_per_dn, noise.read_e,
                             look.noise.origin == "rig" ? "of rig.yaml" : "learned");
  return finding;
}

}  // namespace

std::vector<Finding> JudgeCamera(const CameraLook& look) {
  std::vector<Finding> findings = {JudgeBalls(look)};
  if (look.images == 0 || look.balls < kAnyBall) return findings;
  for (const auto judge : {JudgeExposure, JudgeBackground, JudgeFocus, JudgeSmear, JudgeSize,
                           JudgeCoverage, DescribeNoise}) {
    findings.push_back(judge(look));
  }
  return findings;
}

}  // namespace stereomotion::app
