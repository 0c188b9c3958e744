#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>

#include "check_findings.h"
#include "check_look.h"
#include "check_samples.h"
#include "commands.h"
#include "live_pair.h"
#include "number_within.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/body_file.h"
#include "stereomotion/io/rig_file.h"
#include "stop_signal.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

struct CheckOptions {
  std::string left, right;
  std::string rig;  ///< empty: rig.yaml where there is one
  std::vector<std::string> bodies;
  double seconds = 2;
  double fps = 0;
  bool json = false;
  LiveArguments live;
};

// `check` serves before there is a calibration, too.
Rig LoadRig(CheckOptions& options) {
  std::error_code ignored;
  if (options.rig.empty() && fs::exists("rig.yaml", ignored)) options.rig = "rig.yaml";
  if (!options.rig.empty()) return ReadRig(options.rig);
  if (options.bodies.empty()) return {};
  throw UserError("--body: found no --rig, expected the calibrated cameras: poses need both");
}

std::vector<Body> LoadBodies(const CheckOptions& options) {
  std::vector<Body> bodies;
  for (const std::string& file : options.bodies) bodies.push_back(ReadBody(file));
  return bodies;
}

Samples TakeSamples(const CheckOptions& options, const ResolvedCameras& cameras) {
  if (AreLive(cameras)) {
    spdlog::info("looking for {:.3g} s", options.seconds);
    return SampleLive(cameras, options.live, options.seconds, CatchStopSignals());
  }
  RefuseLiveOptions(options.live);
  return SampleRecording(
      *OpenRecording(cameras.left.path, cameras.right.path, {options.fps, false}));
}

const RigCamera* CameraOf(const Rig& rig, const ResolvedCamera& camera) {
  return camera.rig_camera < 0 || rig.cameras.empty()
             ? nullptr
             : &rig.cameras[static_cast<std::size_t>(camera.rig_camera)];
}

std::string NameOf(const RigCamera* camera, const std::string& argument) {
  return camera != nullptr ? camera->name : argument;
}

Finding JudgeImageSize(const CameraLook& look, const RigCamera& camera, const std::string& rig) {
  Finding finding{"image_size", look.name, Verdict::kGood, "", "", {}};
  finding.text = fmt::format("{} x {} px, as in {}", look.width_px, look.height_px, rig);
  if (look.width_px == camera.width_px && look.height_px == camera.height_px) return finding;
  finding.verdict = Verdict::kMend;
  finding.text = fmt::format(
      "found images of {} x {} px, expected {} x {} px, the image_size_px "
      "in {}",
      look.width_px, look.height_px, camera.width_px, camera.height_px, rig);
  finding.advice = "set the region as it was in the calibration (--region), or calibrate anew";
  return finding;
}

// All that is found; poses only where the images are those that the rig was calibrated for.
std::vector<Finding> Judge(const CheckOptions& options, const ResolvedCameras& cameras, Rig rig,
                           const Samples& samples) {
  std::vector<Finding> findings = JudgeStream(samples.stream);
  bool sizes_fit = true;
  for (const std::size_t side : {0, 1}) {
    const RigCamera* camera = CameraOf(rig, side == 0 ? cameras.left : cameras.right);
    const CameraLook look = LookAt(samples, side, camera);
    if (camera != nullptr && look.images > 0) {
      findings.push_back(JudgeImageSize(look, *camera, options.rig));
      sizes_fit = sizes_fit && findings.back().verdict == Verdict::kGood;
    }
    const std::vector<Finding> more = JudgeCamera(look);
    findings.insert(findings.end(), more.begin(), more.end());
  }
  if (options.bodies.empty() || !sizes_fit || samples.pairs.empty()) return findings;
  MeasureSetup setup;
  setup.rig = std::move(rig);
  setup.left_camera = cameras.left.rig_camera;
  setup.right_camera = cameras.right.rig_camera;
  setup.bodies = LoadBodies(options);
  const std::vector<Finding> more = JudgeBody(MeasureSamples(samples, setup));
  findings.insert(findings.end(), more.begin(), more.end());
  return findings;
}

int RunCheck(CheckOptions& options) {
  const Rig rig = LoadRig(options);
  LoadBodies(options);  // an invalid file is told before the cameras are opened
  const ResolvedCameras cameras = ResolveCameras(options.left, options.right, rig, options.rig);
  for (const auto& note : cameras.notes) spdlog::info(note);
  Samples samples = TakeSamples(options, cameras);
  samples.stream.names = {NameOf(CameraOf(rig, cameras.left), options.left),
                          NameOf(CameraOf(rig, cameras.right), options.right)};
  const std::vector<Finding> findings = Judge(options, cameras, rig, samples);
  fmt::print("{}", options.json ? FindingsJson(findings) : FindingsText(findings));
  return IsReady(findings) ? kDone : kNoAnswer;
}

}  // namespace

Run AddCheckCommand(CLI::App& app) {
  constexpr double kShortest_s = 0.1, kLongest_s = 3600;
  auto options = std::make_shared<CheckOptions>();
  CLI::App* check =
      app.add_subcommand("check", "Looks at two cameras before a take: is all ready?");
  check->add_option("--left", options->left, "Left camera, live or recorded")->required();
  check->add_option("--right", options->right, "Right camera")->required();
  check->add_option("--rig", options->rig, "The calibrated cameras; rig.yaml where it is there");
  check
      ->add_option("--body", options->bodies,
                   "A body (body.yaml) that should be seen; may be given "
                   "several times")
      ->allow_extra_args(false);
  check->add_option("--seconds", options->seconds, "How long live cameras are watched")
      ->check(NumberWithin(kShortest_s, kLongest_s))
      ->capture_default_str();
  check->add_option("--fps", options->fps, "Frames a second, where a recording has no times")
      ->check(NumberWithin(kLowestFps, kHighestFps));
  check->add_flag("--json", options->json, "As JSON, for programs");
  AddLiveOptions(*check, options->live);
  check->footer(
      "Exit code 0: ready; 1: something must be mended.\n"
      "Example: stereomotion check --left cam0 --right cam1 --rig rig.yaml --body body.yaml");
  return [options](const CommonOptions&) { return RunCheck(*options); };
}

}  // namespace stereomotion::app
