#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "stereomotion/io/body_file.h"
#include "stereomotion/io/rig_file.h"
#include "stereomotion/io/scenario_file.h"
#include "stereomotion/simulation/render_scene.h"
#include "stereomotion/simulation/write_recording.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

std::string BytesOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

TEST(DemoRecording, IsRemadeByteForByte) {
  const fs::path demo = fs::path(STEREOMOTION_SOURCE_DIR) / "data/demo";
  const fs::path remade = fs::path(::testing::TempDir()) / "stereomotion_demo_remade";
  fs::remove_all(remade);
  WriteRecording(ReadScenario(demo / "scenario.yaml").scenario, remade);
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(remade)) {
    if (!entry.is_regular_file()) continue;
    const fs::path name = fs::relative(entry.path(), remade);
    EXPECT_TRUE(BytesOf(entry.path()) == BytesOf(demo / name)) << name;
    ++files;
  }
  EXPECT_EQ(files, 2 * (20 + 1) + 3);
  fs::remove_all(remade);
}

fs::path SharedData() {
  const char* given = std::getenv("STEREOMOTION_SHARED_DATA");
  return given != nullptr ? fs::path(given) : fs::path(STEREOMOTION_SOURCE_DIR) / "../shared/data";
}

/// Reads the motion of a recording whose spin centre moves straight from its first true pose.
BodyMotion MotionOf(const fs::path& recording) {
  std::ifstream stream(recording / "truth/poses.csv");
  std::string line;
  std::getline(stream, line);
  std::getline(stream, line);
  std::vector<double> cells;
  std::istringstream row(line);
  for (std::string cell; std::getline(row, cell, ',');) cells.push_back(std::stod(cell));
  const auto vector = [&](int first) {
    return Eigen::Vector3d(cells[first], cells[first + 1], cells[first + 2]);
  };
  Rigid3 world_from_body;
  world_from_body.rotation = {cells[2], cells[3], cells[4], cells[5]};
  world_from_body.rotation.normalize();
  world_from_body.translation_mm = vector(6);
  BodyMotion motion;
  motion.world_from_body = world_from_body.rotation;
  motion.spin_in_world_rad_s = vector(9);
  motion.center_in_world_mm = vector(12);
  motion.center_in_body_mm = world_from_body.Inverse() * vector(12);
  motion.velocity_in_world_mm_s = vector(15);
  return motion;
}

struct Chi2 {
  double sum = 0;
  int count = 0;
};

/// Compares the pixels on and around the balls with what the noise model allows.
void AddChi2(const Scenario& scenario, int camera, int frame, const cv::Mat& seen, Chi2& chi2) {
  MeanImage mean_dn;
  RenderSceneMean(scenario, camera, TimeOfFrame(scenario, camera, frame).true_s, mean_dn);
  const double bright_dn = 1.1 * scenario.light.background_level * 255;
  for (int v = 0; v < mean_dn.rows(); ++v) {
    for (int u = 0; u < mean_dn.cols(); ++u) {
      if (mean_dn(v, u) < bright_dn) continue;
      const double residual_dn = seen.at<unsigned char>(v, u) - mean_dn(v, u);
      chi2.sum += residual_dn * residual_dn / scenario.sensor.noise().VarianceDn2(mean_dn(v, u));
      ++chi2.count;
    }
  }
}

/// Nothing is fitted: an independent renderer's images, made from the same truth, must differ from
/// ours by their noise alone. Two-sided 99.9 % interval of χ² over the two recordings (Šidák).
TEST(RenderScene, AgreesWithAnIndependentRenderer) {
  for (const char* name : {"easy", "spin_fixed"}) {
    const fs::path recording = SharedData() / "rendered" / name;
    if (!fs::exists(recording)) GTEST_SKIP() << recording << " is not here";
    Scenario scenario;
    scenario.rig = ReadRig(recording / "rig.yaml");
    scenario.body = ReadBody(recording / "body.yaml");
    scenario.motion = MotionOf(recording);
    Chi2 chi2;
    for (const int frame : {0, 7, 15}) {
      for (const int camera : {0, 1}) {
        const fs::path image = recording / scenario.rig.cameras[camera].name /
                               (frame < 10 ? "00000" + std::to_string(frame) + ".png"
                                           : "0000" + std::to_string(frame) + ".png");
        const cv::Mat seen = cv::imread(image.string(), cv::IMREAD_UNCHANGED);
        ASSERT_EQ(seen.type(), CV_8UC1) << image;
        AddChi2(scenario, camera, frame, seen, chi2);
      }
    }
    const double z = (chi2.sum - chi2.count) / std::sqrt(2.0 * chi2.count);
    EXPECT_GT(chi2.count, 2000);
    EXPECT_LT(std::fabs(z), 3.48) << name << ": chi2/dof " << chi2.sum / chi2.count;
    RecordProperty(name, std::to_string(chi2.sum / chi2.count));
  }
}

}  // namespace
}  // namespace stereomotion
