#include <fmt/format.h>

#include <array>
#include <cmath>

#include "frame_parts.h"

namespace stereomotion {
namespace {

// More in a row or column than any board that is printed.
constexpr int kMostRows = 200;
// Printed features and their gaps; outside, the unit is wrong.
constexpr double kSmallestFeatureMm = 1;
constexpr double kLargestFeatureMm = 10'000;
struct TagFamily {
  const char* name;
  int num_tags;
};
constexpr std::array<TagFamily, 3> kTagFamilies = {
    {{"tag36h11", 587}, {"tag25h9", 35}, {"tag16h5", 30}}};

double ReadFeature(const YamlReader& node) {
  const double size_mm = node.Positive();
  if (size_mm >= kSmallestFeatureMm && size_mm <= kLargestFeatureMm) return size_mm;
  node.Fail(
      fmt::format("{:g}", size_mm),
      fmt::format("{:g} to {:g} mm{}", kSmallestFeatureMm, kLargestFeatureMm,
                  size_mm < kSmallestFeatureMm
                      ? fmt::format(" (metres? {:g} m would be {:g} mm)", size_mm, size_mm * 1000)
                      : ""));
}

void ReadTags(const YamlReader& node, Target& board) {
  const YamlReader family = node.Required("family");
  board.family = family.Text();
  board.tag_size_mm = ReadFeature(node.Required("tag_size_mm"));
  board.tag_spacing_mm = ReadFeature(node.Required("tag_spacing_mm"));
  std::string names;
  for (const TagFamily& known : kTagFamilies) {
    names += (names.empty() ? "" : ", ") + std::string(known.name);
    if (board.family != known.name) continue;
    if (const auto id = node.Optional("first_id")) board.first_id = id->Integer(0, known.num_tags);
    const int last = board.first_id + board.rows * board.cols - 1;
    if (last >= known.num_tags) {
      node.Fail(fmt::format("tags up to id {}", last),
                fmt::format("ids 0 to {}, all that {} has", known.num_tags - 1, known.name));
    }
    return;
  }
  family.Fail("'" + board.family + "'", "one of " + names);
}

// Turned by half a turn, such a pattern looks the same, so that nothing tells its corners apart.
void RefuseHalfTurn(const YamlReader& node, const Target& board) {
  const bool chessboard = board.type == TargetType::kChessboard;
  if (chessboard && (board.rows + board.cols) % 2 == 0) {
    node.Fail(fmt::format("a chessboard of {} × {} inner corners, which looks the same upside down",
                          board.rows, board.cols),
              fmt::format("one of the numbers even, the other odd: print a board of {} × {} inner "
                          "corners, that is {} × {} squares",
                          board.rows, board.cols + 1, board.rows + 1, board.cols + 2));
  }
  if (board.asymmetric && board.rows % 2 == 0) {
    node.Fail(
        fmt::format("an asymmetric grid of {} rows, which looks the same upside down", board.rows),
        fmt::format("an odd number of rows: print {}", board.rows + 1));
  }
}

bool ReadFlag(const YamlReader& node) {
  const std::string text = node.Text();
  if (text != "true" && text != "false") node.Fail("'" + text + "'", "true or false");
  return text == "true";
}

void ReadCircles(const YamlReader& node, Target& board) {
  if (const auto flag = node.Optional("asymmetric")) board.asymmetric = ReadFlag(*flag);
  const auto diameter = node.Optional("circle_diameter_mm");
  if (!diameter) return;
  board.ball_diameter_mm = ReadFeature(*diameter);
  const double gap_mm = board.spacing_mm * (board.asymmetric ? std::sqrt(2.0) : 1.0);
  if (board.ball_diameter_mm >= gap_mm) {
    diameter->Fail(fmt::format("{:g}", board.ball_diameter_mm),
                   fmt::format("less than the circles' distance, {:.4g} mm", gap_mm));
  }
}

}  // namespace

double ReadBuildSigma(const YamlReader& node, double smallest_feature_mm) {
  const auto sigma = node.Optional("sigma_mm");
  if (!sigma) return 0;
  constexpr double kWorst = 0.1;  // of the smallest feature: no print or wand is that bad
  const double sigma_mm = sigma->NotNegative();
  if (sigma_mm > kWorst * smallest_feature_mm) {
    sigma->Fail(fmt::format("{:g}", sigma_mm),
                fmt::format("at most a tenth of {:g} mm (micrometres?)", smallest_feature_mm));
  }
  return sigma_mm;
}

void ReadBoard(const YamlReader& node, Target& board) {
  const bool tags = board.type == TargetType::kAprilTagGrid;
  const int fewest = tags ? 1 : 3;  // OpenCV finds no pattern of two rows
  board.rows = node.Required("rows").Integer(fewest, kMostRows);
  board.cols = node.Required("cols").Integer(fewest, kMostRows);
  if (tags) {
    ReadTags(node, board);
  } else {
    board.spacing_mm = ReadFeature(node.Required("spacing_mm"));
  }
  if (board.type == TargetType::kCircleGrid) ReadCircles(node, board);
  RefuseHalfTurn(node, board);
  board.points =
      MakeBoardPoints(board, ReadBuildSigma(node, tags ? board.tag_size_mm : board.spacing_mm));
}

}  // namespace stereomotion
