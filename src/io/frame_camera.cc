#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "camera_source.h"
#include "find_images.h"
#include "frame_parts.h"
#include "stereomotion/io/suggest.h"

namespace stereomotion {
namespace {

constexpr int kLargestSidePx = 65536;
// A first DLT of the seeds needs six; a world of surveyed balls is placed by three.
constexpr std::size_t kFewestSeeds = 6;
constexpr std::size_t kFewestWorldSeeds = 3;

using ParameterNames = std::array<const char*, CameraModel::kNumParameters>;
constexpr ParameterNames kFreeNames = {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"};
constexpr ParameterNames kInitialNames = {"fx_px", "fy_px", "cx_px", "cy_px", "k1",
                                          "k2",    "p1",    "p2",    "k3"};

void ReadFree(const YamlReader& node, CalibrationCamera& camera) {
  const std::vector<std::string> known(kFreeNames.begin(), kFreeNames.end());
  camera.free.emplace().fill(false);
  for (const YamlReader& item : node.Items()) {
    const std::string name = item.Text();
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      item.Fail("'" + name + "'", "fx, fy, cx, cy, k1, k2, p1, p2 or k3" + DidYouMean(name, known));
    }
    bool& is_free = camera.free->at(static_cast<std::size_t>(found - known.begin()));
    if (is_free) item.Fail("'" + name + "' twice", "every parameter once");
    is_free = true;
  }
}

// A focal length that is fixed must be known; 0 is none.
void RequireFocalLengths(const YamlReader& node, const CalibrationCamera& camera) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (!camera.free || (*camera.free)[i] || camera.initial[i]) continue;
    node.Fail(fmt::format("no {} in free", kFreeNames[i]),
              fmt::format("it there, or its value in initial: {{{}: …}}", kInitialNames[i]));
  }
}

void ReadInitial(const YamlReader& node, CalibrationCamera& camera) {
  node.RequireKeys({kInitialNames.begin(), kInitialNames.end()});
  for (std::size_t i = 0; i < kInitialNames.size(); ++i) {
    const auto value = node.Optional(kInitialNames[i]);
    if (!value) continue;
    const bool focal = i < 2;
    camera.initial[i] = focal ? value->Positive() : value->Number();
    // Wide open: a view of 157°; images narrower than 500 px are not expected.
    constexpr double kShortest = 0.1, kUsualWidthPx = 500;
    const double width_px = camera.width_px > 0 ? camera.width_px : kUsualWidthPx;
    if (focal && *camera.initial[i] < kShortest * width_px) {
      value->Fail(fmt::format("{:g}", *camera.initial[i]),
                  "the focal length in pixels (not in mm)");
    }
  }
}

void ReadWorld(const YamlReader& node, const FrameFile& frame, const CalibrationCamera& camera,
               FrameCamera& data, InputFiles& inputs) {
  const auto images = node.Optional("world_images");
  const auto seeds = node.Optional("world_seeds");
  if (!frame.world_target) {
    if (images) images->Fail("world_images", "none: the file has no world_points");
    if (seeds) seeds->Fail("world_seeds", "none: the file has no world_points");
    return;
  }
  data.world_images = FindImages(node.Required("world_images"));
  data.world_seeds = ReadSeeds(node.Required("world_seeds"), *frame.world_target, camera,
                               kFewestWorldSeeds, inputs);
}

}  // namespace

CalibrationCamera ReadCalibrationCamera(const YamlReader& node) {
  node.RequireKeys({"name", "source", "image_size_px", "images", "observations", "seeds", "free",
                    "initial", "world_images", "world_seeds"});
  CalibrationCamera camera;
  camera.name = node.Required("name").Name();
  if (const auto source = node.Optional("source")) {
    ReadCameraSource(*source, camera.source, camera.source_settings);
  }
  if (const auto size = node.Optional("image_size_px")) {
    if (size->Numbers(2).size() == 2) {
      camera.width_px = size->Items()[0].Integer(1, kLargestSidePx);
      camera.height_px = size->Items()[1].Integer(1, kLargestSidePx);
    }
  }
  if (const auto free = node.Optional("free")) ReadFree(*free, camera);
  if (const auto initial = node.Optional("initial")) ReadInitial(*initial, camera);
  RequireFocalLengths(node, camera);
  return camera;
}

FrameCamera ReadFrameCamera(const YamlReader& node, const FrameFile& frame, InputFiles& inputs) {
  const CalibrationCamera& camera = frame.setup.cameras.back();
  const Target& target = frame.setup.target;
  FrameCamera data;
  const auto images = node.Optional("images");
  const auto observations = node.Optional("observations");
  if (images.has_value() == observations.has_value()) {
    node.Fail(images ? "both images and observations" : "neither images nor observations",
              "images: cam0/*.png, or observations: points.csv");
  }
  if (images) data.images = FindImages(*images);
  if (observations) {
    if (camera.width_px == 0) node.Fail("observations alone", "image_size_px: [w, h] with them");
    data.observations = ReadObservations(*observations, target, camera, inputs);
  }
  if (const auto seeds = node.Optional("seeds")) {
    if (target.type != TargetType::kControlPoints || observations) {
      seeds->Fail("seeds", "none: they belong to images of control points");
    }
    data.seeds = ReadSeeds(*seeds, target, camera, kFewestSeeds, inputs);
  }
  ReadWorld(node, frame, camera, data, inputs);
  return data;
}

}  // namespace stereomotion
