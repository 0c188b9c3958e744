#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "stereomotion/calibration/find_control_points.h"
#include "stereomotion/detection/estimate_noise.h"
#include "tests/support/number_table.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;
using testing::ReadGrey;
using testing::ReadNumbers;
using testing::Uniform;

fs::path SharedData() {
  const char* given = std::getenv("STEREOMOTION_SHARED_DATA");
  return given != nullptr ? fs::path(given) : fs::path(STEREOMOTION_SOURCE_DIR) / "../shared/data";
}

int PointAt(const Target& target, const Eigen::Vector3d& p_mm) {
  for (std::size_t i = 0; i < target.points.size(); ++i) {
    if ((target.points[i].xyz_mm - p_mm).norm() < 0.01) return static_cast<int>(i);
  }
  return -1;
}

/// The dot target of MyPTV, seen by one camera.
struct RealCamera {
  Target target;
  Image image;
  SensorNoise noise;
  std::map<int, Eigen::Vector2d> peer_px;  ///< what the peer measured, by point
  std::vector<Seed> manual;
};

RealCamera ReadReal(const fs::path& folder, int camera) {
  const std::string name = "cam" + std::to_string(camera);
  RealCamera real;
  for (const auto& row : ReadNumbers(folder / "target_file")) {
    real.target.points.push_back(
        {std::to_string(real.target.points.size()), {row[0], row[1], row[2]}, 0});
  }
  real.image = ReadGrey(folder / ("cal" + std::to_string(camera) + ".tif"));
  real.noise = EstimateNoise({real.image.View()}).value();
  for (const auto& row : ReadNumbers(folder / (name + "_cal_points"))) {
    real.peer_px[PointAt(real.target, {row[2], row[3], row[4]})] = {row[0], row[1]};
  }
  for (const auto& row : ReadNumbers(folder / (name + "_manualPoints"))) {
    if (row[0] < 0) continue;  // the peer's mark for "not clicked"
    real.manual.push_back({PointAt(real.target, {row[2], row[3], row[4]}), {row[0], row[1]}});
  }
  return real;
}

/// Checks that what the peer lists is found, and nothing in the wrong place: 5 px is a sixth of the
/// distance between dots, and twice what a glint moves the peer's centroids.
void ExpectFound(const RealCamera& real, const ControlPointView& view) {
  int found = 0;
  for (const LabelledBall& ball : view.balls) {
    const auto peer = real.peer_px.find(ball.point);
    if (peer == real.peer_px.end()) continue;
    ++found;
    EXPECT_LT((ball.ball.center_px - peer->second).norm(), 5) << ball.point;
  }
  EXPECT_GE(found, 0.98 * static_cast<double>(real.peer_px.size()));
}

class RealControlFrame : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    const fs::path folder = SharedData() / "real/control_frame_myptv";
    if (!fs::exists(folder)) GTEST_SKIP() << folder << " is absent";
    real_ = ReadReal(folder, GetParam());
  }
  RealCamera real_;
};

TEST_P(RealControlFrame, SixManualSeeds) {
  ASSERT_EQ(real_.manual.size(), 6U);
  const auto view = FindControlPoints(real_.image.View(), real_.noise, real_.target, real_.manual);
  ASSERT_TRUE(view) << view.error().text;
  ExpectFound(real_, *view);
}

TEST_P(RealControlFrame, RandomSeeds) {
  auto rng = testing::MakeTestRng(static_cast<std::uint64_t>(GetParam()));
  std::vector<std::pair<int, Eigen::Vector2d>> peer(real_.peer_px.begin(), real_.peer_px.end());
  for (int draw = 0; draw < 12; ++draw) {
    std::vector<Seed> seeds;
    std::shuffle(peer.begin(), peer.end(), rng);
    const std::size_t count = draw % 2 == 0 ? 6 : 8;
    for (std::size_t i = 0; i < count; ++i) {
      seeds.push_back({peer[i].first, peer[i].second + Eigen::Vector2d(Uniform(rng, -15, 15),
                                                                       Uniform(rng, -15, 15))});
    }
    const bool wrong = draw % 4 == 3;  // one of eight
    if (wrong) seeds[3].pixel_px = {Uniform(rng, 250, 1000), Uniform(rng, 150, 850)};
    const auto view = FindControlPoints(real_.image.View(), real_.noise, real_.target, seeds);
    if (!view && view.error().failure == LabelFailure::kFlat) continue;  // it happens, and is told
    ASSERT_TRUE(view) << draw << ": " << view.error().text;
    ExpectFound(real_, *view);
  }
}

INSTANTIATE_TEST_SUITE_P(Cameras, RealControlFrame, ::testing::Values(1, 2, 3));

/// The target file is YAML, one line a point.
Target ReadRenderedTarget(const fs::path& file) {
  std::ifstream stream(file);
  Target target;
  for (std::string line; std::getline(stream, line);) {
    const auto bracket = line.find("xyz_mm: [");
    if (bracket == std::string::npos) continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line.substr(bracket + 9));
    TargetPoint point{std::to_string(target.points.size()), {}, 0.2};
    words >> point.xyz_mm.x() >> point.xyz_mm.y() >> point.xyz_mm.z();
    target.points.push_back(point);
  }
  return target;
}

std::vector<Seed> ReadRenderedSeeds(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<Seed> seeds;
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    Seed seed;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line.substr(1));  // "P00 …"
    words >> seed.point >> seed.pixel_px.x() >> seed.pixel_px.y();
    EXPECT_TRUE(words) << line;
    seeds.push_back(seed);
  }
  return seeds;
}

TEST(RenderedControlFrame, CentresAreConsistent) {
  const fs::path folder = SharedData() / "rendered/calib_points";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is absent";
  const Target target = ReadRenderedTarget(folder / "frame.yaml");
  const auto truth = ReadNumbers(folder / "truth/balls.csv");
  testing::ErrorStatistics errors;
  for (const int camera : {0, 1}) {
    const std::string name = "cam" + std::to_string(camera);
    const auto seeds = ReadRenderedSeeds(folder / (name + "_seeds.csv"));
    for (const int frame : {0, 1}) {
      const Image image = ReadGrey(folder / name / ("00000" + std::to_string(frame) + ".png"));
      const auto noise = EstimateNoise({image.View()});
      ASSERT_TRUE(noise);
      const auto view = FindControlPoints(image.View(), *noise, target, seeds);
      ASSERT_TRUE(view) << view.error().text;
      EXPECT_EQ(view->balls.size(), target.points.size());
      for (const auto& row : truth) {  // frame, cam, rod, ball, X, Y, Z, u, v, ue, ve, …
        if (row[0] != frame || row[1] != camera) continue;
        const auto ball = std::find_if(
            view->balls.begin(), view->balls.end(),
            [&](const LabelledBall& b) { return b.point == static_cast<int>(row[3]); });
        ASSERT_NE(ball, view->balls.end());
        errors.Add(ball->ball.center_px - Eigen::Vector2d(row[9], row[10]),
                   ball->ball.covariance_px2);
      }
    }
  }
  EXPECT_EQ(errors.samples(), 120);
  EXPECT_TRUE(IsConsistent(errors, testing::FamilyZ(1)));
}

}  // namespace
}  // namespace stereomotion
