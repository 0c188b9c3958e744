#include <fmt/format.h>

#include "frame_parts.h"
#include "stereomotion/io/suggest.h"

namespace stereomotion {
namespace {

// Six points determine the eleven coefficients of a DLT.
constexpr std::size_t kFewestPoints = 6;
// Three points that are not on a line place a world.
constexpr std::size_t kFewestWorldPoints = 3;
// Singular values: nearer to a plane (line) than that is one, typed with rounded coordinates.
constexpr double kFlat = 1e-3;

struct TargetKind {
  const char* name;
  TargetType type;
  std::vector<std::string> keys;
};

const std::vector<TargetKind>& Kinds() {
  static const std::vector<TargetKind> kinds = {
      {"control_points", TargetType::kControlPoints, {"type", "ball_diameter_mm", "points"}},
      {"apriltag_grid",
       TargetType::kAprilTagGrid,
       {"type", "family", "rows", "cols", "tag_size_mm", "tag_spacing_mm", "first_id", "sigma_mm"}},
      {"chessboard", TargetType::kChessboard, {"type", "rows", "cols", "spacing_mm", "sigma_mm"}},
      {"circle_grid",
       TargetType::kCircleGrid,
       {"type", "rows", "cols", "spacing_mm", "asymmetric", "circle_diameter_mm", "sigma_mm"}},
      {"wand", TargetType::kWand, {"type", "ball_diameter_mm", "distances_mm", "sigma_mm"}}};
  return kinds;
}

const TargetKind& ReadKind(const YamlReader& node) {
  const YamlReader type = node.Required("type");
  const std::string name = type.Text();
  std::vector<std::string> names;
  for (const TargetKind& kind : Kinds()) {
    if (name == kind.name) return kind;
    names.emplace_back(kind.name);
  }
  type.Fail("'" + name + "'", "control_points, apriltag_grid, chessboard, circle_grid or wand" +
                                  DidYouMean(name, names));
}

void ReadWand(const YamlReader& node, Target& wand) {
  wand.ball_diameter_mm = ReadBallDiameter(node.Required("ball_diameter_mm"), false);
  const YamlReader distances = node.Required("distances_mm");
  const std::vector<double> x_mm = distances.Numbers();
  constexpr std::size_t kFewest = 2, kMost = 9;
  if (x_mm.size() < kFewest || x_mm.size() > kMost) {
    distances.Fail(std::to_string(x_mm.size()) + " balls", "2 to 9, each ball's place on the wand");
  }
  for (std::size_t i = 1; i < x_mm.size(); ++i) {
    if (x_mm[i] > x_mm[i - 1]) continue;
    distances.Fail(fmt::format("{:g} behind {:g}", x_mm[i], x_mm[i - 1]),
                   "ascending places on the wand, from its first ball (not gaps)");
  }
  wand.points = MakeWandPoints(x_mm, ReadBuildSigma(node, x_mm.back() - x_mm.front()));
  CheckPoints(distances, wand);
}

void ReadControlPoints(const YamlReader& node, InputFiles& inputs, Target& target) {
  target.ball_diameter_mm = ReadBallDiameter(node.Required("ball_diameter_mm"), true);
  const YamlReader points = node.Required("points");
  target.points = ReadTargetPoints(points, inputs);
  CheckPoints(points, target);
  if (target.points.size() < kFewestPoints) {
    points.Fail(fmt::format("{} points", target.points.size()), "6 or more, better 12");
  }
  const double depth = RelativeDepth(target.points);
  if (depth >= kFlat) return;
  points.Fail(fmt::format("points in one plane (depth {:.1e} of their length)", depth),
              "points in depth, too: raise some of them, by a fifth of the frame or more");
}

}  // namespace

Target ReadTarget(const YamlReader& node, InputFiles& inputs) {
  const TargetKind& kind = ReadKind(node);
  node.RequireKeys(kind.keys);
  Target target;
  target.type = kind.type;
  if (IsBoard(kind.type)) {
    ReadBoard(node, target);
  } else if (kind.type == TargetType::kWand) {
    ReadWand(node, target);
  } else {
    ReadControlPoints(node, inputs, target);
  }
  return target;
}

Target ReadWorldTarget(const YamlReader& node, InputFiles& inputs) {
  node.RequireKeys({"ball_diameter_mm", "points"});
  Target target;
  target.ball_diameter_mm = ReadBallDiameter(node.Required("ball_diameter_mm"), true);
  const YamlReader points = node.Required("points");
  target.points = ReadTargetPoints(points, inputs);
  CheckPoints(points, target);
  if (target.points.size() < kFewestWorldPoints || RelativeWidth(target.points) < kFlat) {
    points.Fail(fmt::format("{} points{}", target.points.size(),
                            target.points.size() < kFewestWorldPoints ? "" : " on one line"),
                "3 or more, not on one line: they define the world");
  }
  return target;
}

}  // namespace stereomotion
