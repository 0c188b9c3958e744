#include "refine_run.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "refine_inputs.h"
#include "stereomotion/calibration/refine_rig.h"
#include "stereomotion/core/units.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/rig_writer.h"
#include "stereomotion/io/write_file.h"
#include "version.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

// Residuals of twenty times the noise: lenses that are a little wrong stay far below.
constexpr double kNoRigFits = 400;

void CheckOutput(const RefineOptionsOfRun& options, const fs::path& rig) {
  const fs::path file = options.output;
  std::error_code error;
  if (fs::equivalent(rig, file, error)) {
    throw UserError(options.output + ": is the rig that is refined, expected another --output");
  }
  if (fs::is_directory(file, error)) {
    throw UserError(options.output + ": is a folder, expected a file (--output)");
  }
  if (!fs::is_directory(fs::absolute(file).parent_path(), error)) {
    throw UserError(options.output + ": its folder does not exist (--output)");
  }
  if (fs::exists(file, error) && !options.force) {
    throw UserError(options.output + ": exists; give --force to overwrite, or another --output");
  }
}

// Length of a vector with its standard uncertainty along itself.
std::string Length(const Eigen::Vector3d& vector, const Eigen::Matrix3d& covariance, double unit) {
  const double length = vector.norm();
  const Eigen::Vector3d along =
      length > 0 ? Eigen::Vector3d(vector / length) : Eigen::Vector3d(Eigen::Vector3d::UnitX());
  const double sigma = std::sqrt(std::max(0.0, along.dot(covariance * along)));
  return fmt::format("{:.4f} ± {:.4f}", unit * length, unit * sigma);
}

std::string Table(const RefinedRig& refined, std::size_t num_frames) {
  const CameraMotion& motion = refined.motion;
  const auto& cameras = refined.rig.cameras;
  std::string table = fmt::format("{} against {} (the world stays with {}):\n", cameras[1].name,
                                  cameras[0].name, cameras[0].name);
  const auto line = [&](const std::string& name, const std::string& text) {
    table += fmt::format("  {:<24} {}\n", name, text);
  };
  line("turned by",
       Length(motion.change.head<3>(), motion.covariance.topLeftCorner<3, 3>(), kDegreesPerRadian) +
           " deg");
  line("moved by",
       Length(motion.change.tail<3>(), motion.covariance.bottomRightCorner<3, 3>(), 1) + " mm");
  line("baseline", fmt::format("{:.3f} → {:.3f} ± {:.3f} mm", motion.baseline_before_mm,
                               motion.baseline_after_mm, motion.baseline_sigma_mm));
  line("change", motion.significant
                     ? fmt::format("significant (χ² {:.3g}, 6 expected)", motion.chi2)
                     : fmt::format("none (χ² {:.1f}, 6 expected)", motion.chi2));
  line("chi2 per dof", fmt::format("{:.2f} → {:.2f} (1 is ideal)", refined.chi2_dof_before,
                                   refined.chi2_dof_after));
  line("residual rms", fmt::format("{:.4f} px", refined.rms_px));
  line("frames used", fmt::format("{} of {}", refined.frames.size(), num_frames));
  line("images of balls",
       fmt::format("{} used, {} left out", refined.balls_used, refined.balls_rejected));
  return table;
}

CalibrationRecord MakeRecord(const RefineOptionsOfRun& options, const RefinedRig& refined) {
  CalibrationRecord record;
  record.date = options.date;
  record.program = std::string("stereomotion ") + kVersion;
  record.source = options.run;
  record.target = "rods of a run";
  record.views = static_cast<int>(refined.frames.size());
  record.rms_px = refined.rms_px;
  record.chi2_dof = refined.chi2_dof_after;
  return record;
}

}  // namespace

int RefineRun(const RefineOptionsOfRun& options, const CommonOptions& common) {
  const RefineInputs inputs = LoadRefineInputs(options);
  CheckOutput(options, inputs.rig_file);
  for (const std::string& note : inputs.notes) spdlog::warn("{}", note);
  const auto refined = RefineRig(inputs.rig, inputs.body, inputs.frames);
  if (!refined) {
    fmt::print(stderr, "stereomotion: {}: {}: {}\n", options.run, refined.error().name,
               refined.error().text);
    return kNoAnswer;
  }
  for (const auto& note : refined->warnings) spdlog::warn("{}: {}", note.name, note.text);
  if (refined->chi2_dof_after > kNoRigFits) {
    fmt::print(stderr,
               "stereomotion: {}: no rig fits this run's rods (χ²/dof {:.3g}, 1 expected): rig or "
               "body of other cameras or another body?\n",
               options.run, refined->chi2_dof_after);
    return kNoAnswer;
  }
  WriteFileAtomically(options.output, RigYaml(refined->rig, MakeRecord(options, *refined)));
  if (!common.quiet) fmt::print("{}", Table(*refined, inputs.frames.size()));
  fmt::print("{}\n", options.output);
  return kDone;
}

}  // namespace stereomotion::app
