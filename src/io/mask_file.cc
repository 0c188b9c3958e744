#include "stereomotion/io/mask_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "number_text.h"
#include "yaml_reader.h"

namespace stereomotion {
namespace {

constexpr const char* kFormat = "stereomotion-mask/1";
// More is no list of lamps and windows; each polygon costs a pass over its rows.
constexpr std::size_t kMostPolygons = 1000, kMostCorners = 1000;
constexpr std::size_t kMostCornersInAll = 100000;  // of a file: seconds, not hours

const RigCamera& CameraOf(const Rig& rig, const std::string& name) {
  return *std::find_if(rig.cameras.begin(), rig.cameras.end(),
                       [&](const RigCamera& camera) { return camera.name == name; });
}

// Polygons may reach over the border, by a whole image; farther out, the unit is wrong.
void CheckCorner(const YamlReader& node, const Eigen::Vector2d& corner, const RigCamera& camera) {
  const Eigen::Vector2d size_px(camera.width_px, camera.height_px);
  const bool near =
      (corner.array() >= -size_px.array()).all() && (corner.array() <= 2 * size_px.array()).all();
  if (near) return;
  node.Fail(fmt::format("[{:g}, {:g}]", corner.x(), corner.y()),
            fmt::format("[u, v] in pixels of an image of {} x {} px (0, 0 is the centre of the "
                        "first one)",
                        camera.width_px, camera.height_px));
}

ImagePolygon ReadPolygon(const YamlReader& node, const RigCamera& camera) {
  const std::vector<YamlReader> corners = node.Items();
  if (corners.size() < 3 || corners.size() > kMostCorners) {
    node.Fail(std::to_string(corners.size()) + " corners",
              fmt::format("3 to {} corners [u, v]", kMostCorners));
  }
  ImagePolygon polygon;
  for (const YamlReader& corner : corners) {
    const std::vector<double> uv = corner.Numbers(2);
    polygon.emplace_back(uv[0], uv[1]);
    CheckCorner(corner, polygon.back(), camera);
  }
  ImageMask covered(camera.width_px, camera.height_px);
  MarkPolygon(polygon, covered);
  if (covered.CountMasked() == 0) {
    node.Fail("a polygon that covers no pixel", "one that holds the centre of at least one pixel");
  }
  return polygon;
}

CameraMask ReadCamera(const YamlReader& node, const RigCamera& camera, std::size_t& corners) {
  CameraMask mask;
  mask.camera = camera.name;
  const std::vector<YamlReader> polygons = node.Items();
  if (polygons.size() > kMostPolygons) {
    node.Fail(std::to_string(polygons.size()) + " polygons",
              fmt::format("at most {}", kMostPolygons));
  }
  for (const YamlReader& polygon : polygons) {
    corners += polygon.Items().size();
    if (corners > kMostCornersInAll) {
      polygon.Fail("more corners", fmt::format("at most {} in all polygons", kMostCornersInAll));
    }
    mask.regions.push_back({ReadPolygon(polygon, camera), ""});
  }
  return mask;
}

// A line break would end the comment.
std::string OneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return text;
}

std::string RegionText(const MaskRegion& region) {
  std::string text;
  if (!region.comment.empty()) text += "    # " + OneLine(region.comment) + "\n";
  text += "    - [";
  for (std::size_t i = 0; i < region.polygon.size(); ++i) {
    text += fmt::format("{}[{}, {}]", i > 0 ? ", " : "", NumberText(region.polygon[i].x()),
                        NumberText(region.polygon[i].y()));
  }
  return text + "]\n";
}

}  // namespace

std::vector<CameraMask> ReadMask(const std::filesystem::path& file, const Rig& rig) {
  const YamlReader root = YamlReader::Load(file);
  const YamlReader format = root.Required("format");
  if (format.Text() != kFormat) {
    format.Fail("'" + format.Text() + "'", fmt::format("'{}'", kFormat));
  }
  root.RequireKeys({"format", "cameras"});
  const YamlReader cameras = root.Required("cameras");
  std::vector<std::string> names;
  for (const RigCamera& camera : rig.cameras) names.push_back(camera.name);
  cameras.RequireKeys(names);
  std::vector<CameraMask> masks;
  std::size_t corners = 0;
  for (const std::string& name : cameras.Keys()) {
    masks.push_back(ReadCamera(cameras.Required(name), CameraOf(rig, name), corners));
  }
  return masks;
}

std::string MaskYaml(const std::vector<CameraMask>& masks, const std::string& comment) {
  std::string text = "# " + OneLine(comment) + "\n";
  text += fmt::format("format: {}\n", kFormat);
  text += "cameras:  # polygons [u, v] in pixels; (0, 0) is the centre of the top-left pixel\n";
  for (const CameraMask& mask : masks) {
    text += fmt::format("  {}:{}\n", QuotedText(mask.camera), mask.regions.empty() ? " []" : "");
    for (const MaskRegion& region : mask.regions) text += RegionText(region);
  }
  return text;
}

ImageMask MakeMask(const std::vector<CameraMask>& masks, const RigCamera& camera) {
  ImageMask image_mask;
  for (const CameraMask& mask : masks) {
    if (mask.camera != camera.name || mask.regions.empty()) continue;
    if (image_mask.empty()) image_mask = ImageMask(camera.width_px, camera.height_px);
    for (const MaskRegion& region : mask.regions) MarkPolygon(region.polygon, image_mask);
  }
  return image_mask;
}

}  // namespace stereomotion
