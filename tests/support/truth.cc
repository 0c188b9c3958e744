#include "tests/support/truth.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace stereomotion::testing {
namespace {

namespace fs = std::filesystem;

/// Reads a CSV file with a header row by column names.
class Table {
 public:
  explicit Table(const fs::path& file) : file_(file), stream_(file) {
    if (!Next()) throw std::runtime_error(file.string() + ": no such file, or it is empty");
    for (std::size_t i = 0; i < cells_.size(); ++i) columns_[cells_[i]] = i;
  }
  bool Next() {
    std::string line;
    if (!std::getline(stream_, line)) return false;
    cells_.clear();
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells_.push_back(cell);
    return true;
  }
  [[nodiscard]] const std::string& Text(const std::string& column) const {
    const auto found = columns_.find(column);
    if (found == columns_.end() || found->second >= cells_.size()) {
      throw std::runtime_error(file_.string() + ": no column " + column);
    }
    return cells_[found->second];
  }
  [[nodiscard]] double Number(const std::string& column) const { return std::stod(Text(column)); }

 private:
  fs::path file_;
  std::ifstream stream_;
  std::vector<std::string> cells_;
  std::map<std::string, std::size_t> columns_;
};

int RodIndex(const Body& body, const std::string& name) {
  for (std::size_t r = 0; r < body.rods.size(); ++r) {
    if (body.rods[r].name == name) return static_cast<int>(r);
  }
  return -1;  // a ball of no rod
}

void ReadPoses(const fs::path& file, Truth& truth) {
  Table table(file);
  while (table.Next()) {
    TrueFrame& frame = truth[std::stoll(table.Text("frame"))];
    Rigid3& pose = frame.world_from_body;
    pose.rotation = Eigen::Quaterniond(table.Number("qw"), table.Number("qx"), table.Number("qy"),
                                       table.Number("qz"))
                        .normalized();
    pose.translation_mm = {table.Number("tx_mm"), table.Number("ty_mm"), table.Number("tz_mm")};
    frame.omega_rad_s = {table.Number("wx_rad_s"), table.Number("wy_rad_s"),
                         table.Number("wz_rad_s")};
    frame.center_mm = {table.Number("center_x_mm"), table.Number("center_y_mm"),
                       table.Number("center_z_mm")};
    frame.velocity_mm_s = {table.Number("vx_mm_s"), table.Number("vy_mm_s"),
                           table.Number("vz_mm_s")};
  }
}

void ReadBalls(const fs::path& file, const Body& body, const std::array<std::string, 2>& cameras,
               Truth& truth) {
  Table table(file);
  while (table.Next()) {
    TrueBall ball;
    ball.id = {RodIndex(body, table.Text("rod")), std::stoi(table.Text("ball"))};
    ball.p_in_world_mm = {table.Number("x_mm"), table.Number("y_mm"), table.Number("z_mm")};
    ball.center_px = {table.Number("u_px"), table.Number("v_px")};
    ball.outline_px = {table.Number("outline_u_px"), table.Number("outline_v_px")};
    ball.diameter_px = table.Number("diameter_px");
    ball.visible = table.Number("visible");
    ball.inside = table.Number("inside") != 0;
    const auto camera = std::find(cameras.begin(), cameras.end(), table.Text("camera"));
    if (camera == cameras.end()) {
      throw std::runtime_error(file.string() + ": unknown camera " + table.Text("camera"));
    }
    const auto side = static_cast<std::size_t>(camera - cameras.begin());
    truth[std::stoll(table.Text("frame"))].balls[side].push_back(ball);
  }
}

}  // namespace

const TrueBall* TrueFrame::Find(int camera, const BallId& id) const {
  for (const TrueBall& ball : balls[static_cast<std::size_t>(camera)]) {
    if (ball.id == id) return &ball;
  }
  return nullptr;
}

bool TrueFrame::ShowsRods(const Body& body, int wanted) const {
  for (int r = 0; r < static_cast<int>(body.rods.size()); ++r) {
    for (const std::vector<TrueBall>& seen : balls) {
      const auto shown = std::count_if(seen.begin(), seen.end(), [&](const TrueBall& ball) {
        return ball.id.rod == r && ball.IsShown();
      });
      if (shown < wanted) return false;
    }
  }
  return true;
}

Truth ReadTruth(const fs::path& recording, const Body& body,
                const std::array<std::string, 2>& cameras) {
  Truth truth;
  ReadPoses(recording / "truth/poses.csv", truth);
  ReadBalls(recording / "truth/balls.csv", body, cameras, truth);
  return truth;
}

}  // namespace stereomotion::testing
