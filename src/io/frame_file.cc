#include "stereomotion/io/frame_file.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "frame_parts.h"

namespace stereomotion {
namespace {

// Fewer points left for the fit determine no camera.
constexpr std::size_t kFewestPoints = 6;
constexpr double kFlat = 1e-3;  // as in ReadTarget

int ReadPointId(const YamlReader& node, const Target& target) {
  const std::string id = node.Text();
  const int point = FindPoint(target, id);
  if (point < 0) node.Fail("'" + id + "'", "an id of the target" + SuggestPoint(target, id));
  return point;
}

void ReadWorldPoints(const YamlReader& node, FrameFile& frame) {
  if (frame.setup.target.type == TargetType::kWand && !frame.world_target) {
    node.Fail("a world for a wand, which has no place of its own",
              "world_points with it, or no world: then it is the first camera's frame");
  }
  node.RequireKeys({"origin", "x_axis", "xy_plane"});
  const Target& target = frame.world_target ? *frame.world_target : frame.setup.target;
  const WorldPoints world = {ReadPointId(node.Required("origin"), target),
                             ReadPointId(node.Required("x_axis"), target),
                             ReadPointId(node.Required("xy_plane"), target)};
  const auto at = [&](int point) { return target.points[static_cast<std::size_t>(point)].xyz_mm; };
  const Eigen::Vector3d x = at(world.x_axis) - at(world.origin);
  const Eigen::Vector3d y = at(world.xy_plane) - at(world.origin);
  if (world.origin == world.x_axis) {
    node.Required("x_axis").Fail("the same point as origin", "another one");
  }
  // The sine of the angle at the origin: the axes would turn with the survey's errors.
  constexpr double kSmallestSine = 0.01;
  if (world.xy_plane == world.origin || world.xy_plane == world.x_axis ||
      x.cross(y).norm() < kSmallestSine * x.norm() * y.norm()) {
    node.Required("xy_plane").Fail("a point on the line from origin to x_axis", "one beside it");
  }
  frame.setup.world = world;
}

void ReadCheckPoints(const YamlReader& node, CalibrationSetup& setup) {
  if (setup.target.type != TargetType::kControlPoints) {
    node.Fail("check points", "none: they belong to control points");
  }
  std::vector<TargetPoint> left = setup.target.points;
  for (const YamlReader& item : node.Items()) {
    const int point = ReadPointId(item, setup.target);
    const auto& known = setup.check_points;
    if (std::find(known.begin(), known.end(), point) != known.end()) {
      item.Fail("'" + item.Text() + "' twice", "every point once");
    }
    setup.check_points.push_back(point);
    const std::string& id = setup.target.points[static_cast<std::size_t>(point)].id;
    left.erase(std::find_if(left.begin(), left.end(),
                            [&](const TargetPoint& other) { return other.id == id; }));
  }
  if (left.size() < kFewestPoints || RelativeDepth(left) < kFlat) {
    node.Fail(fmt::format("check points that leave {} points{} for the fit", left.size(),
                          left.size() < kFewestPoints ? "" : ", all in one plane,"),
              "6 or more left, in depth, too");
  }
}

void ReadCameras(const YamlReader& list, FrameFile& frame) {
  const std::vector<YamlReader> nodes = list.Items();
  constexpr std::size_t kFewestCameras = 2;
  if (nodes.size() < kFewestCameras) {
    list.Fail(fmt::format("{} camera(s)", nodes.size()), "2 or more");
  }
  for (const YamlReader& node : nodes) {
    frame.setup.cameras.push_back(ReadCalibrationCamera(node));
    const auto& cameras = frame.setup.cameras;
    for (std::size_t i = 0; i + 1 < cameras.size(); ++i) {
      if (cameras[i].name != cameras.back().name) continue;
      node.Required("name").Fail("'" + cameras[i].name + "' twice", "a name of its own");
    }
    frame.cameras.push_back(ReadFrameCamera(node, frame, frame.inputs));
  }
}

using ImageList = std::vector<std::filesystem::path> FrameCamera::*;

// Returns how many images each camera has; 0: none has any.
int CommonCount(const YamlReader& cameras, const FrameFile& frame, ImageList list) {
  int first = -1;
  for (std::size_t i = 0; i < frame.cameras.size(); ++i) {
    const auto& images = frame.cameras[i].*list;
    if (images.empty()) continue;
    if (first < 0) first = static_cast<int>(i);
    const auto f = static_cast<std::size_t>(first);
    const auto& others = frame.cameras[f].*list;
    if (images.size() != others.size()) {
      cameras.Fail(
          fmt::format("{} images of {} and {} of {}", others.size(), frame.setup.cameras[f].name,
                      images.size(), frame.setup.cameras[i].name),
          "the same number: image n of each camera is view n");
    }
    if (f != i && images == others) {
      cameras.Fail(fmt::format("the same images for {} and {}", frame.setup.cameras[f].name,
                               frame.setup.cameras[i].name),
                   "images of its own for each camera");
    }
  }
  return first < 0
             ? 0
             : static_cast<int>((frame.cameras[static_cast<std::size_t>(first)].*list).size());
}

void CountViews(const YamlReader& cameras, FrameFile& frame) {
  CommonCount(cameras, frame, &FrameCamera::world_images);
  const int num_images = CommonCount(cameras, frame, &FrameCamera::images);
  frame.num_views = num_images;
  for (std::size_t i = 0; i < frame.cameras.size(); ++i) {
    for (const MeasuredPoint& measured : frame.cameras[i].observations) {
      frame.num_views = std::max(frame.num_views, measured.view + 1);
    }
    if (num_images > 0 && frame.num_views > num_images) {
      cameras.Fail(
          fmt::format("view {} in the observations of {}", frame.num_views - 1,
                      frame.setup.cameras[i].name),
          fmt::format("0 to {}: the other cameras have {} images", num_images - 1, num_images));
    }
  }
}

void ListInputs(FrameFile& frame) {
  for (const FrameCamera& camera : frame.cameras) {
    for (const auto* images : {&camera.images, &camera.world_images}) {
      frame.inputs.insert(frame.inputs.end(), images->begin(), images->end());
    }
  }
  std::vector<std::filesystem::path> unique;
  for (const auto& file : frame.inputs) {
    if (std::find(unique.begin(), unique.end(), file) == unique.end()) unique.push_back(file);
  }
  frame.inputs = std::move(unique);
}

YamlReader LoadRoot(const std::filesystem::path& file) {
  YamlReader root = YamlReader::Load(file);
  const YamlReader format = root.Required("format");
  if (format.Text() != "stereomotion-frame/1") {
    format.Fail("'" + format.Text() + "'", "'stereomotion-frame/1'");
  }
  root.RequireKeys({"format", "target", "cameras", "world", "world_points", "check_points"});
  return root;
}

}  // namespace

FrameFile ReadFrame(const std::filesystem::path& file) {
  const YamlReader root = LoadRoot(file);
  FrameFile frame;
  frame.inputs.push_back(file);
  frame.setup.target = ReadTarget(root.Required("target"), frame.inputs);
  if (const auto points = root.Optional("world_points")) {
    if (frame.setup.target.type != TargetType::kWand) {
      points->Fail("world_points", "none: they belong to a wand");
    }
    frame.world_target = ReadWorldTarget(*points, frame.inputs);
  }
  const YamlReader cameras = root.Required("cameras");
  ReadCameras(cameras, frame);
  CountViews(cameras, frame);
  if (const auto world = root.Optional("world")) ReadWorldPoints(*world, frame);
  if (const auto check = root.Optional("check_points")) ReadCheckPoints(*check, frame.setup);
  ListInputs(frame);
  return frame;
}

Target ReadFrameTarget(const std::filesystem::path& file) {
  InputFiles inputs = {file};
  return ReadTarget(LoadRoot(file).Required("target"), inputs);
}

}  // namespace stereomotion
