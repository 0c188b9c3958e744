#include "refine_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "stereomotion/capture/sha256.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/body_file.h"
#include "stereomotion/io/rig_file.h"
#include "stereomotion/io/run_reader.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

// The file that the user gives, else the one that the run names; told where that has changed.
fs::path InputFile(const RunOrigin& origin, const fs::path& run, const std::string& role,
                   const std::string& given, std::vector<std::string>& notes) {
  if (!given.empty()) return given;
  const RunInput* input = origin.Input(role);
  if (input == nullptr) {
    throw UserError(fmt::format("{}: inputs: names no {}; give --{} FILE",
                                (run / "run.json").string(), role, role));
  }
  std::error_code ignored;
  if (!fs::is_regular_file(input->path, ignored)) {
    throw UserError(fmt::format("{}: the {} of the run {} is not there any more; give --{} FILE",
                                input->path, role, run.string(), role));
  }
  if (!input->sha256.empty() && Sha256OfFile(input->path) != input->sha256) {
    notes.push_back(fmt::format("{}: has changed since the run {} read it as its {}", input->path,
                                run.string(), role));
  }
  return input->path;
}

// What --refine reads: the folder of a body, and the RUN that it belongs to.
struct Places {
  fs::path folder, root;
  RunOrigin origin;
};

Places FindPlaces(const fs::path& folder) {
  Places places{folder, RootOfRun(folder), {}};
  places.origin = ReadRunOrigin(places.root);
  if (places.root != folder || places.origin.body_folders.empty()) return places;
  std::string expected;
  for (const std::string& body : places.origin.body_folders) {
    expected += (expected.empty() ? "" : ", ") + (folder / body).string();
  }
  throw UserError(fmt::format("{}: has {} bodies, expected the folder of one (--refine): {}",
                              folder.string(), places.origin.body_folders.size(), expected));
}

// Of several bodies, or a learned one, the copy beside its files.
fs::path BodyFile(const Places& places, const std::string& given, std::vector<std::string>& notes) {
  const fs::path copy = places.folder / "body.yaml";
  const bool named = places.root == places.folder && places.origin.Input("body") != nullptr;
  std::error_code ignored;
  if (given.empty() && !named && fs::is_regular_file(copy, ignored)) return copy;
  return InputFile(places.origin, places.root, "body", given, notes);
}

int CameraOf(const Rig& rig, const std::string& name, const fs::path& file) {
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    if (rig.cameras[c].name == name) return static_cast<int>(c);
  }
  throw UserError(fmt::format("{}: cameras: found no {}, which the run used", file.string(), name));
}

// The two cameras of a rig, and of its covariance what concerns them: the marginal.
Rig PairOf(const Rig& rig, const std::array<int, 2>& cameras) {
  Rig pair;
  for (const int camera : cameras) pair.cameras.push_back(rig.cameras[camera]);
  if (!rig.covariance) return pair;
  RigCovariance covariance;
  std::vector<int> rows;
  for (std::size_t i = 0; i < rig.covariance->parameters.size(); ++i) {
    const RigParameter& parameter = rig.covariance->parameters[i];
    const auto* const place = std::find(cameras.begin(), cameras.end(), parameter.camera);
    if (place == cameras.end()) continue;
    covariance.parameters.push_back({static_cast<int>(place - cameras.begin()), parameter.index});
    rows.push_back(static_cast<int>(i));
  }
  if (rows.empty()) return pair;
  const auto size = static_cast<Eigen::Index>(rows.size());
  covariance.matrix.resize(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      covariance.matrix(i, j) = rig.covariance->matrix(rows[i], rows[j]);
    }
  }
  pair.covariance = std::move(covariance);
  return pair;
}

void CheckBody(const Body& body, const fs::path& file) {
  const bool whole = std::any_of(body.rods.begin(), body.rods.end(),
                                 [](const Rod& rod) { return rod.balls_in_body_mm.size() >= 3; });
  if (!whole) throw UserError(file.string() + ": rods: found none of three balls or more");
}

}  // namespace

RefineInputs LoadRefineInputs(const RefineOptionsOfRun& options) {
  const Places places = FindPlaces(options.run);
  const RunOrigin& origin = places.origin;
  RefineInputs inputs;
  inputs.rig_file = InputFile(origin, places.root, "rig", options.rig, inputs.notes);
  const fs::path body = BodyFile(places, options.body, inputs.notes);
  const Rig rig = ReadRig(inputs.rig_file);
  inputs.body = ReadBody(body);
  CheckBody(inputs.body, body);
  const int left = CameraOf(rig, origin.left_camera, inputs.rig_file);
  const int right = CameraOf(rig, origin.right_camera, inputs.rig_file);
  inputs.rig = PairOf(rig, {std::min(left, right), std::max(left, right)});
  if (rig.cameras.size() > 2) {
    inputs.notes.push_back(fmt::format(
        "{}: the refined rig has {} and {} only: the run saw nothing with the others",
        inputs.rig_file.string(), inputs.rig.cameras[0].name, inputs.rig.cameras[1].name));
  }
  for (RunDetections& pair :
       ReadDetections(places.folder, origin.left_camera, origin.right_camera)) {
    if (right < left) std::swap(pair.balls[0], pair.balls[1]);
    inputs.frames.push_back({pair.frame, std::move(pair.balls)});
  }
  return inputs;
}

}  // namespace stereomotion::app
