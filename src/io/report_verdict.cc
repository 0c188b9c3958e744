#include "report_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "report_text.h"

namespace stereomotion {
namespace {

// Held-out error against the predicted one. The RMS of n points scatters by about 1/√(6 n): by 30 %
// with two of them, so that 1.5 is hardly chance and 2.5 never.
constexpr double kSuspect = 1.5, kWrong = 2.5;
// Single image points are mislabelled or covered in every recording; more of them is a pattern.
constexpr double kFewOutliers = 0.02;

const std::array<const char*, 6> kGrave = {
    "systematic_residuals", "wrong_pairs",      "ball_size",
    "implausible_distance", "implausible_lens", "swapped_cameras"};

double Ratio(double rms_mm, double predicted_mm) {
  return predicted_mm > 0 ? rms_mm / predicted_mm : 0;
}

double CheckRatio(const CalibrationSummary& summary) {
  const auto& held = summary.check_points;
  return held ? Ratio(held->rms_mm, held->predicted_rms_mm) : 0;
}

double CrossRatio(const Calibration& calibration) {
  const auto& cross = calibration.cross_validation;
  return cross ? Ratio(cross->rms_mm, cross->predicted_rms_mm) : 0;
}

double ShareLeftOut(const CalibrationSummary& summary) {
  int used = 0, left_out = 0;
  for (const auto& camera : summary.cameras) {
    used += camera.used;
    left_out += camera.left_out;
  }
  return used + left_out > 0 ? static_cast<double>(left_out) / (used + left_out) : 0;
}

std::string TargetWords(const CalibrationSetup& setup) {
  const Target& target = setup.target;
  const auto board = [&](const char* what) {
    return fmt::format("{} ({} × {})", what, target.rows, target.cols);
  };
  switch (target.type) {
    case TargetType::kControlPoints:
      return fmt::format("{} control points", target.points.size());
    case TargetType::kAprilTagGrid:
      return board("an AprilTag grid");
    case TargetType::kChessboard:
      return board("a chessboard");
    case TargetType::kCircleGrid:
      return board("a circle grid");
    default:
      return fmt::format("a wand of {} balls", target.points.size());
  }
}

std::string WhatSentence(const Calibration& calibration, const CalibrationSetup& setup) {
  std::vector<std::string> names;
  for (const auto& camera : setup.cameras) names.push_back(camera.name);
  const auto used = std::count(calibration.view_used.begin(), calibration.view_used.end(), true);
  return fmt::format(
      "{} cameras ({}) were calibrated with {} in {} of {} views; {} parameters "
      "were estimated.",
      names.size(), fmt::join(names, ", "), TargetWords(setup), used, calibration.view_used.size(),
      calibration.free_parameters.size());
}

std::string FitSentence(const Calibration& calibration, const CalibrationSummary& summary) {
  int used = 0, left_out = 0;
  for (const auto& camera : summary.cameras) {
    used += camera.used;
    left_out += camera.left_out;
  }
  return fmt::format(
      "The model fits {} image points to {} px (RMS of a coordinate), χ²/dof {} with "
      "{} degrees of freedom; {} image points were left out as outliers.",
      used, Digits(calibration.rms_px, 3), Digits(calibration.chi2_dof, 3), calibration.dof,
      left_out);
}

std::string VolumeSentence(const CalibrationSummary& summary) {
  if (!summary.random_mm) return "No place of the volume is seen by two cameras.";
  return fmt::format(
      "Expected standard uncertainty of a ball's position, per coordinate, in the working volume: "
      "{} mm random, from image noise of one image pair (worst {} mm); {} mm common to all "
      "frames, from this calibration (worst {} mm).",
      Digits(summary.random_mm->median, 2), Digits(summary.random_mm->largest, 2),
      Digits(summary.calibration_mm->median, 2), Digits(summary.calibration_mm->largest, 2));
}

std::string HeldOutSentence(const std::string& who, double rms_mm, double predicted_mm) {
  const std::string ratio =
      predicted_mm > 0 ? fmt::format(", {} times that", Digits(rms_mm / predicted_mm, 2)) : "";
  return fmt::format("{}: 3D error {} mm RMS, predicted {} mm{}.", who, Digits(rms_mm, 3),
                     Digits(predicted_mm, 3), ratio);
}

}  // namespace

VerdictLevel Judge(const Calibration& calibration, const CalibrationSummary& summary) {
  // Cross-validation compares outliers, too: with them it says nothing grave about the rig.
  const double check = CheckRatio(summary), cross = CrossRatio(calibration);
  const bool outliers = ShareLeftOut(summary) > 0;
  bool warned = std::max(check, cross) > kSuspect;
  bool grave = check > kWrong || (cross > kWrong && !outliers);
  for (const CalibrationNote& note : calibration.warnings) {
    grave = grave || std::find(kGrave.begin(), kGrave.end(), note.name) != kGrave.end();
    warned = warned || note.name != "outliers" || ShareLeftOut(summary) > kFewOutliers;
  }
  if (grave) return VerdictLevel::kDoubtful;
  return warned ? VerdictLevel::kUsableWithWarnings : VerdictLevel::kGood;
}

std::string VerdictName(VerdictLevel level) {
  if (level == VerdictLevel::kGood) return "good";
  return level == VerdictLevel::kDoubtful ? "doubtful" : "usable_with_warnings";
}

std::string VerdictWords(VerdictLevel level) {
  if (level == VerdictLevel::kGood) return "Good";
  return level == VerdictLevel::kDoubtful ? "Doubtful: read the warnings before you measure with it"
                                          : "Usable, with warnings";
}

std::vector<std::string> VerdictSentences(const Calibration& calibration,
                                          const CalibrationSetup& setup,
                                          const CalibrationSummary& summary) {
  std::vector<std::string> sentences = {WhatSentence(calibration, setup),
                                        FitSentence(calibration, summary), VolumeSentence(summary)};
  if (const auto& held = summary.check_points) {
    sentences.push_back(
        HeldOutSentence(fmt::format("{} check points, kept out of the fit", held->num_points),
                        held->rms_mm, held->predicted_rms_mm));
  }
  if (const auto& cross = calibration.cross_validation) {
    sentences.push_back(HeldOutSentence(
        fmt::format("{}-fold cross-validation, {} points each calibrated without{}", cross->folds,
                    cross->num_points,
                    ShareLeftOut(summary) > 0 ? " (outliers are compared, too)" : ""),
        cross->rms_mm, cross->predicted_rms_mm));
  }
  if (!summary.check_points && !calibration.cross_validation) {
    sentences.emplace_back(
        "No points were kept out of the fit, so nothing here proves the 3D "
        "accuracy independently.");
  }
  return sentences;
}

}  // namespace stereomotion
