#include <fmt/format.h>

#include <algorithm>

#include "check_findings.h"

namespace stereomotion::app {
namespace {

constexpr double kPercent = 100;
/// As the verdict of report.html: usable with warnings below 95 %, doubtful below a half.
constexpr double kMostPoses = 0.95, kHalfOfPoses = 0.5;
/// A body's own rods hide some of its balls from some sides; a half is too many.
constexpr double kMostBalls = 0.7, kHalfOfBalls = 0.5;
/// Reflections that a mask should take away; below, the body's shape tells them apart.
constexpr double kManyFalse = 3;

std::string MostFrequentLoss(const BodyLook& look) {
  const auto worst =
      std::max_element(look.lost_by_reason.begin(), look.lost_by_reason.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return worst == look.lost_by_reason.end() ? "" : worst->first;
}

std::string AdviceFor(const std::string& reason) {
  if (reason == "inconsistent") {
    return "the cameras contradict each other: one was moved (calibrate --refine), or they are "
           "not in step";
  }
  if (reason == "roll_undetermined") return "only one rod is seen: turn the body or move a camera";
  if (reason == "ambiguous") return "the rods look alike: thread their balls at other distances";
  return "is the body the one of --body, and whole in both images? Is rig.yaml of these cameras, "
         "left and right not exchanged, none moved since?";
}

Finding JudgePose(const BodyLook& look) {
  Finding finding{"body", "", Verdict::kGood, "", "", {}};
  const double share =
      look.pairs > 0 ? static_cast<double>(look.poses) / static_cast<double>(look.pairs) : 0;
  finding.values = {{"pose_share", share}};
  finding.text = fmt::format("found in {} of {} pairs", look.poses, look.pairs);
  if (!look.first_pose.empty()) finding.text += ", first at " + look.first_pose;
  if (share < kMostPoses) {
    const std::string reason = MostFrequentLoss(look);
    finding.verdict = share < kHalfOfPoses ? Verdict::kMend : Verdict::kMind;
    finding.text += "; mostly " + reason;
    finding.advice = look.swapped.empty() ? AdviceFor(reason) : look.swapped;
  }
  return finding;
}

Finding JudgeUsedBalls(const BodyLook& look) {
  Finding finding{"body_balls", "", Verdict::kGood, "", "", {}};
  const double fewest = std::min(look.used_balls[0], look.used_balls[1]) /
                        static_cast<double>(std::max<std::int64_t>(1, look.expected_balls));
  finding.values = {{"left", look.used_balls[0]},
                    {"right", look.used_balls[1]},
                    {"expected", static_cast<double>(look.expected_balls)}};
  finding.text = fmt::format("{:.1f} left and {:.1f} right of {} balls are seen and used",
                             look.used_balls[0], look.used_balls[1], look.expected_balls);
  if (fewest < kMostBalls) {
    finding.verdict = fewest < kHalfOfBalls ? Verdict::kMend : Verdict::kMind;
    finding.advice =
        "what hides the others (a hand, a cable, the body itself)? Move the cameras, "
        "or clean and replace dull balls";
  }
  return finding;
}

Finding JudgeResiduals(const BodyLook& look) {
  const double level = look.median_chi2_dof.value_or(1);
  Finding finding{"residuals", "", Verdict::kGood, "", "", {{"median_chi2_dof", level}}};
  finding.text = fmt::format("χ²/dof {:.2f}: rig, body and images agree", level);
  if (level >= kRemarkableChi2Dof) {
    finding.verdict = level >= kDoubtfulChi2Dof ? Verdict::kMend : Verdict::kMind;
    finding.text = fmt::format(
        "χ²/dof {:.2f} where 1 is expected: rig, body or synchronisation do "
        "not fit the images",
        level);
    finding.advice =
        "was a camera bumped (calibrate --refine), are the cameras triggered together, "
        "is body.yaml measured well?";
  }
  return finding;
}

Finding JudgeFalseBlobs(const BodyLook& look) {
  Finding finding{"reflections", "", Verdict::kGood, "", "", {{"an_image", look.false_blobs}}};
  finding.text = fmt::format("{:.1f} false balls an image", look.false_blobs);
  if (look.false_blobs > kManyFalse) {
    finding.verdict = Verdict::kMind;
    finding.advice = "cover what shines, or learn a mask: track --learn-mask mask.yaml";
  }
  return finding;
}

}  // namespace

std::vector<Finding> JudgeBody(const BodyLook& look) {
  std::vector<Finding> findings = {JudgePose(look)};
  if (look.poses > 0) {
    findings.push_back(JudgeUsedBalls(look));
    if (look.median_chi2_dof) findings.push_back(JudgeResiduals(look));
  }
  findings.push_back(JudgeFalseBlobs(look));
  return findings;
}

}  // namespace stereomotion::app
