#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "csv_table.h"
#include "frame_parts.h"

namespace stereomotion {
namespace {

constexpr int kMostViews = 1'000'000;
// Outside the image by more than that, a seed belongs to another image.
constexpr double kSeedTolerancePx = 15;

int ReadPoint(const CsvTable& table, std::size_t row, const Target& target) {
  const std::string& id = table.Text(row, "id");
  const int point = FindPoint(target, id);
  if (point < 0) {
    table.Fail(row, "id", "'" + id + "'", "an id of the target" + SuggestPoint(target, id));
  }
  return point;
}

Eigen::Vector2d ReadPixel(const CsvTable& table, std::size_t row, const CalibrationCamera& camera) {
  const Eigen::Vector2d pixel_px(table.Number(row, "u_px"), table.Number(row, "v_px"));
  const auto outside = [](double x_px, int side_px) {
    return x_px < -kSeedTolerancePx || x_px > side_px - 1 + kSeedTolerancePx;
  };
  const bool known = camera.width_px > 0;
  if (known && (outside(pixel_px.x(), camera.width_px) || outside(pixel_px.y(), camera.height_px)))
    table.Fail(
        row, "u_px", fmt::format("({:g}, {:g})", pixel_px.x(), pixel_px.y()),
        fmt::format("a place in the image of {} × {} px", camera.width_px, camera.height_px));
  return pixel_px;
}

void RefuseTwice(const YamlReader& node, const Target& target,
                 const std::vector<MeasuredPoint>& observations) {
  std::vector<std::pair<int, int>> seen;
  seen.reserve(observations.size());
  for (const MeasuredPoint& measured : observations) {
    seen.emplace_back(measured.view, measured.point);
  }
  std::sort(seen.begin(), seen.end());
  const auto twice = std::adjacent_find(seen.begin(), seen.end());
  if (twice != seen.end()) {
    const auto point = static_cast<std::size_t>(twice->second);
    node.Fail(fmt::format("point '{}' twice in view {} of {}", target.points[point].id,
                          twice->first, node.Text()),
              "every point once a view");
  }
}

}  // namespace

std::vector<Seed> ReadSeeds(const YamlReader& node, const Target& target,
                            const CalibrationCamera& camera, std::size_t fewest,
                            InputFiles& inputs) {
  inputs.push_back(node.file().parent_path() / node.Text());
  const CsvTable table = CsvTable::Load(inputs.back(), {"id", "u_px", "v_px"});
  std::vector<Seed> seeds;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const Seed seed{ReadPoint(table, i, target), ReadPixel(table, i, camera)};
    for (const Seed& other : seeds) {
      if (other.point == seed.point) {
        table.Fail(i, "id", "'" + table.Text(i, "id") + "' twice", "every point once");
      }
    }
    seeds.push_back(seed);
  }
  if (seeds.size() < fewest) {
    node.Fail(fmt::format("{} seeds in {}", seeds.size(), inputs.back().string()),
              fmt::format("{} or more, or none", fewest));
  }
  return seeds;
}

std::vector<MeasuredPoint> ReadObservations(const YamlReader& node, const Target& target,
                                            const CalibrationCamera& camera, InputFiles& inputs) {
  inputs.push_back(node.file().parent_path() / node.Text());
  const CsvTable table =
      CsvTable::Load(inputs.back(), {"id", "u_px", "v_px"}, {"sigma_px", "view"});
  std::vector<MeasuredPoint> observations;
  for (std::size_t i = 0; i < table.size(); ++i) {
    MeasuredPoint measured{ReadPoint(table, i, target), 0, ReadPixel(table, i, camera), {}};
    if (table.Has("view")) measured.view = table.Integer(i, "view", 0, kMostViews);
    if (table.Has("sigma_px")) measured.sigma_px = table.Number(i, "sigma_px");
    if (measured.sigma_px && !(*measured.sigma_px > 0)) {
      table.Fail(i, "sigma_px", fmt::format("{:g}", *measured.sigma_px), "a number above 0");
    }
    observations.push_back(measured);
  }
  RefuseTwice(node, target, observations);
  return observations;
}

}  // namespace stereomotion
