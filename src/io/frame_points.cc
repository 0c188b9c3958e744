#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>

#include "csv_table.h"
#include "frame_parts.h"
#include "stereomotion/io/suggest.h"

namespace stereomotion {
namespace {

// Bounds of what can be meant; outside, the unit is wrong.
constexpr double kSmallestSpreadMm = 5;
constexpr double kLargestSpreadMm = 100'000;
constexpr double kSmallestBallMm = 0.5;
constexpr double kLargestBallMm = 500;
// A survey worse than this share of the frame is no survey.
constexpr double kWorstSigma = 0.1;

std::vector<TargetPoint> ReadList(const YamlReader& node) {
  std::vector<TargetPoint> points;
  for (const YamlReader& item : node.Items()) {
    item.RequireKeys({"id", "xyz_mm", "sigma_mm"});
    TargetPoint point{item.Required("id").Name(), item.Required("xyz_mm").Vector3(), 0};
    if (const auto sigma = item.Optional("sigma_mm")) point.sigma_mm = sigma->NotNegative();
    for (const TargetPoint& other : points) {
      if (other.id == point.id) item.Fail("the id '" + point.id + "' twice", "an id of its own");
    }
    points.push_back(std::move(point));
  }
  return points;
}

std::vector<TargetPoint> ReadTable(const std::filesystem::path& file) {
  const CsvTable table = CsvTable::Load(file, {"id", "x_mm", "y_mm", "z_mm"}, {"sigma_mm"});
  std::vector<TargetPoint> points;
  for (std::size_t i = 0; i < table.size(); ++i) {
    TargetPoint point{table.Text(i, "id"), {}, 0};
    point.xyz_mm = {table.Number(i, "x_mm"), table.Number(i, "y_mm"), table.Number(i, "z_mm")};
    if (table.Has("sigma_mm")) point.sigma_mm = table.Number(i, "sigma_mm");
    if (point.sigma_mm < 0) table.Fail(i, "sigma_mm", "a number below 0", "0 or more");
    for (const TargetPoint& other : points) {
      if (other.id == point.id) table.Fail(i, "id", "'" + point.id + "' twice", "an id of its own");
    }
    points.push_back(std::move(point));
  }
  return points;
}

Eigen::Vector3d SingularValues(const std::vector<TargetPoint>& points) {
  Eigen::Matrix3Xd centred(3, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    centred.col(static_cast<Eigen::Index>(i)) = points[i].xyz_mm;
  }
  centred.colwise() -= centred.rowwise().mean().eval();
  // Padded, so that there are three values whatever the number of points.
  Eigen::Matrix3Xd padded = Eigen::Matrix3Xd::Zero(3, centred.cols() + 3);
  padded.leftCols(centred.cols()) = centred;
  return Eigen::JacobiSVD<Eigen::Matrix3Xd>(padded).singularValues();
}

double Ratio(double value, double largest) { return largest > 0 ? value / largest : 0; }

void CheckSpread(const YamlReader& node, const Target& target) {
  Eigen::Vector3d low = target.points[0].xyz_mm, high = low;
  double sigma_mm = 0;
  for (const TargetPoint& point : target.points) {
    low = low.cwiseMin(point.xyz_mm);
    high = high.cwiseMax(point.xyz_mm);
    sigma_mm = std::max(sigma_mm, point.sigma_mm);
  }
  const double spread_mm = (high - low).maxCoeff();
  if (spread_mm < kSmallestSpreadMm || spread_mm > kLargestSpreadMm) {
    node.Fail(fmt::format("points spread over {:.4g} mm", spread_mm),
              fmt::format("{} to {} mm{}", kSmallestSpreadMm, kLargestSpreadMm,
                          spread_mm < kSmallestSpreadMm ? " (metres given as millimetres?)"
                                                        : " (micrometres given as millimetres?)"));
  }
  if (sigma_mm > kWorstSigma * spread_mm) {
    node.Fail(fmt::format("sigma_mm {:.4g} on points spread over {:.4g} mm", sigma_mm, spread_mm),
              "the survey's standard uncertainty in mm (micrometres?)");
  }
}

}  // namespace

std::vector<TargetPoint> ReadTargetPoints(const YamlReader& node, InputFiles& inputs) {
  if (node.IsList()) return ReadList(node);
  if (node.IsMap()) node.Fail("a map", "a list of {id, xyz_mm, sigma_mm}, or a CSV file");
  inputs.push_back(node.file().parent_path() / node.Text());
  return ReadTable(inputs.back());
}

double ReadBallDiameter(const YamlReader& node, bool admit_flat) {
  const double diameter_mm = node.NotNegative();
  if (admit_flat && diameter_mm == 0) return 0;
  if (diameter_mm < kSmallestBallMm || diameter_mm > kLargestBallMm) {
    node.Fail(fmt::format("{:g}", diameter_mm),
              fmt::format("{:g} to {:g} mm{}", kSmallestBallMm, kLargestBallMm,
                          diameter_mm < kSmallestBallMm ? " (metres given as millimetres?)" : ""));
  }
  return diameter_mm;
}

void CheckPoints(const YamlReader& node, const Target& target) {
  const auto& points = target.points;
  if (points.empty()) node.Fail("no points", "a list of {id, xyz_mm, sigma_mm}, or a CSV file");
  CheckSpread(node, target);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const double distance_mm = (points[i].xyz_mm - points[j].xyz_mm).norm();
      if (distance_mm > 0 && distance_mm >= target.ball_diameter_mm) continue;
      node.Fail(fmt::format("points {} and {} only {:.4g} mm apart", points[i].id, points[j].id,
                            distance_mm),
                distance_mm > 0 ? fmt::format("at least the balls' diameter, {:g} mm (is one of "
                                              "them in another unit?)",
                                              target.ball_diameter_mm)
                                : std::string("every point once"));
    }
  }
}

int FindPoint(const Target& target, const std::string& id) {
  const auto found = std::find_if(target.points.begin(), target.points.end(),
                                  [&](const TargetPoint& point) { return point.id == id; });
  return found == target.points.end() ? -1 : static_cast<int>(found - target.points.begin());
}

std::string SuggestPoint(const Target& target, const std::string& id) {
  std::vector<std::string> ids;
  for (const TargetPoint& point : target.points) ids.push_back(point.id);
  return DidYouMean(id, ids);
}

double RelativeDepth(const std::vector<TargetPoint>& points) {
  const Eigen::Vector3d values = SingularValues(points);
  return Ratio(values[2], values[0]);
}

double RelativeWidth(const std::vector<TargetPoint>& points) {
  const Eigen::Vector3d values = SingularValues(points);
  return Ratio(values[1], values[0]);
}

}  // namespace stereomotion
