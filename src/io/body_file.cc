#include "stereomotion/io/body_file.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "body_parameters.h"
#include "covariance_yaml.h"
#include "stereomotion/core/user_error.h"
#include "yaml_reader.h"

namespace stereomotion {
namespace {

// Bounds of what can be meant; outside, the unit is wrong.
constexpr double kSmallestBodyMm = 1;
constexpr double kLargestBodyMm = 100'000;
constexpr double kSmallestBallMm = 0.5;
constexpr double kLargestBallMm = 500;
// A rod bent by more than this share of its length is a slip of the pen, not a bent rod.
constexpr double kStraightness = 0.01;

std::string UnitHint(double size_mm) {
  return size_mm < 1 ? fmt::format(" ({:g} m would be {:g} mm; lengths are in mm, not metres)",
                                   size_mm, size_mm * 1000)
                     : " (lengths are in mm)";
}

void CheckDiameter(const YamlReader& node, double diameter_mm) {
  if (diameter_mm >= kSmallestBallMm && diameter_mm <= kLargestBallMm) return;
  node.Fail(fmt::format("{:g}", diameter_mm), fmt::format("{:g} to {:g} mm{}", kSmallestBallMm,
                                                          kLargestBallMm, UnitHint(diameter_mm)));
}

void CheckSpacing(const YamlReader& balls, const Rod& rod) {
  const auto& p = rod.balls_in_body_mm;
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    for (std::size_t j = i + 1; j < p.size(); ++j) {
      const double distance_mm = (p[i] - p[j]).norm();
      if (distance_mm >= rod.ball_diameter_mm) continue;
      balls.Fail(fmt::format("balls {} and {} only {:g} mm apart", i, j, distance_mm),
                 fmt::format("at least their diameter, {:g} mm{}", rod.ball_diameter_mm,
                             distance_mm < 1 ? UnitHint(distance_mm) : ""));
    }
  }
}

// The line through the balls: their mean and the direction of largest spread.
void CheckLine(const YamlReader& balls, const Rod& rod, double sigma_mm) {
  const auto& p = rod.balls_in_body_mm;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& ball : p) mean += ball / static_cast<double>(p.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const auto& ball : p) spread += (ball - mean) * (ball - mean).transpose();
  const Eigen::Vector3d line =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
  const double length_mm = std::abs(line.dot(p.back() - p.front()));
  const double allowed_mm = std::max(kStraightness * length_mm, 5 * sigma_mm);
  std::size_t worst = 0;
  double worst_mm = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Eigen::Vector3d offset_mm = p[i] - mean;
    const double off_mm = (offset_mm - line * line.dot(offset_mm)).norm();
    if (off_mm > worst_mm) worst = i, worst_mm = off_mm;
  }
  if (worst_mm > allowed_mm) {
    balls.Fail(
        fmt::format("ball {} lies {:.3g} mm off the line of rod {}", worst, worst_mm, rod.name),
        fmt::format("balls on a straight line to within {:.3g} mm", allowed_mm));
  }
  const double direction = line.dot(p.back() - p.front());
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    if (line.dot(p[i + 1] - p[i]) * direction > 0) continue;
    balls.Fail(fmt::format("ball {} not between its neighbours on rod {}", i + 1, rod.name),
               "the balls in the order in which they are threaded");
  }
}

Rod ReadRod(const YamlReader& node) {
  node.RequireKeys({"name", "ball_diameter_mm", "balls_mm", "sigma_mm"});
  Rod rod;
  rod.name = node.Required("name").Name();
  const YamlReader diameter = node.Required("ball_diameter_mm");
  rod.ball_diameter_mm = diameter.Positive();
  if (const auto sigma = node.Optional("sigma_mm")) rod.sigma_mm = sigma->NotNegative();
  const YamlReader balls = node.Required("balls_mm");
  for (const YamlReader& ball : balls.Items()) rod.balls_in_body_mm.push_back(ball.Vector3());
  constexpr std::size_t kFewest = 3, kMost = 9;
  const std::size_t count = rod.balls_in_body_mm.size();
  if (count < kFewest || count > kMost) {
    balls.Fail(std::to_string(count) + " balls", "3 to 9 balls a rod");
  }
  CheckDiameter(diameter, rod.ball_diameter_mm);
  return rod;
}

// A ball that the block does not name keeps its rod's sigma_mm.
void ReadCovariance(const YamlReader& node, Body& body) {
  const NamedCovariance named =
      ReadNamedCovariance(node, BallParameterNames(body), "a coordinate of a ball");
  Eigen::MatrixXd covariance_mm2 = CovarianceOfBalls(body);
  for (std::size_t i = 0; i < named.places.size(); ++i) {
    for (std::size_t j = 0; j < named.places.size(); ++j) {
      covariance_mm2(static_cast<Eigen::Index>(named.places[i]),
                     static_cast<Eigen::Index>(named.places[j])) =
          named.matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  }
  body.covariance_mm2 = std::move(covariance_mm2);
}

void CheckExtent(const YamlReader& rods, const Body& body) {
  Eigen::Vector3d low = body.rods[0].balls_in_body_mm[0], high = low;
  for (const Rod& rod : body.rods) {
    for (const auto& ball : rod.balls_in_body_mm) {
      low = low.cwiseMin(ball);
      high = high.cwiseMax(ball);
    }
  }
  const double extent_mm = (high - low).maxCoeff();
  if (extent_mm >= kSmallestBodyMm && extent_mm <= kLargestBodyMm) return;
  rods.Fail(fmt::format("a body of {:g} mm", extent_mm),
            fmt::format("{:g} to {:g} mm{}", kSmallestBodyMm, kLargestBodyMm, UnitHint(extent_mm)));
}

}  // namespace

Body ReadBody(const std::filesystem::path& file) {
  const YamlReader root = YamlReader::Load(file);
  const YamlReader format = root.Required("format");
  if (format.Text() != "stereomotion-body/1") {
    format.Fail("'" + format.Text() + "'", "'stereomotion-body/1'");
  }
  root.RequireKeys({"format", "name", "rods", "covariance"});
  Body body;
  if (const auto name = root.Optional("name")) body.name = name->Name();
  const YamlReader rods = root.Required("rods");
  const std::vector<YamlReader> nodes = rods.Items();
  if (nodes.empty()) rods.Fail("no rods", "at least one");
  for (const YamlReader& node : nodes) {
    Rod rod = ReadRod(node);
    for (const Rod& other : body.rods) {
      if (other.name == rod.name) {
        node.Required("name").Fail("'" + rod.name + "' twice", "a name of its own");
      }
    }
    body.rods.push_back(std::move(rod));
  }
  if (const auto covariance = root.Optional("covariance")) ReadCovariance(*covariance, body);
  CheckExtent(rods, body);
  for (std::size_t i = 0; i < body.rods.size(); ++i) {
    const YamlReader balls = nodes[i].Required("balls_mm");
    CheckSpacing(balls, body.rods[i]);
    CheckLine(balls, body.rods[i], std::max(body.rods[i].sigma_mm, LargestBallSigmaMm(body)));
  }
  return body;
}

}  // namespace stereomotion
