#include "tests/support/real_control_frame.h"

#include <filesystem>
#include <set>
#include <stdexcept>
#include <utility>

#include "stereomotion/detection/estimate_noise.h"
#include "tests/support/number_table.h"
#include "tests/support/recording_run.h"

namespace stereomotion::testing {
namespace {

namespace fs = std::filesystem;

// The target's maker states neither. The dots are some 6 px wide at 12 px/mm; the survey's σ is
// what good milling keeps, and where it is wrong the calibration says so (`survey_sigma`).
constexpr double kDotDiameterMm = 0.5;
constexpr double kSurveySigmaMm = 0.02;

fs::path Folder() { return SharedData() / "real/control_frame_myptv"; }

Target ReadTarget() {
  Target target;
  target.ball_diameter_mm = kDotDiameterMm;
  for (const auto& row : ReadNumbers(Folder() / "target_file")) {
    target.points.push_back({"D" + std::to_string(target.points.size()),
                             {row.at(0), row.at(1), row.at(2)},
                             kSurveySigmaMm});
  }
  return target;
}

int PointAt(const Target& target, const Eigen::Vector3d& p_mm) {
  constexpr double kSameMm = 0.01;  // both files give two decimals at most
  for (std::size_t i = 0; i < target.points.size(); ++i) {
    if ((target.points[i].xyz_mm - p_mm).norm() < kSameMm) return static_cast<int>(i);
  }
  throw std::runtime_error("control_frame_myptv: a point is not in target_file");
}

std::map<int, Eigen::Vector2d> ReadPoints(const fs::path& file, const Target& target) {
  std::map<int, Eigen::Vector2d> pixels_px;
  for (const auto& row : ReadNumbers(file)) {
    if (row.at(0) < 0) continue;  // the peer's mark for "not clicked"
    pixels_px[PointAt(target, {row.at(2), row.at(3), row.at(4)})] = {row[0], row[1]};
  }
  return pixels_px;
}

RealFrameCamera Observe(const Target& target, int index) {
  const std::string number = std::to_string(index + 1);
  RealFrameCamera camera;
  camera.name = "cam" + number;
  const Image image = ReadGrey(Folder() / ("cal" + number + ".tif"));
  const ImageView view = image.View();
  camera.width_px = view.width_px;
  camera.height_px = view.height_px;
  camera.peer_px = ReadPoints(Folder() / (camera.name + "_cal_points"), target);
  ObservedImage which{index, 0, EstimateNoise({view}).value(), {}};
  for (const auto& [point, pixel_px] :
       ReadPoints(Folder() / (camera.name + "_manualPoints"), target)) {
    which.seeds.push_back({point, pixel_px});
  }
  camera.num_seeds = static_cast<int>(which.seeds.size());
  camera.sight = ObserveTarget(view, target, which);
  return camera;
}

RealPair MakePair(const RealControlFrame& frame, const std::pair<int, int>& cameras) {
  RealPair pair;
  pair.setup.target = frame.target;
  std::map<int, std::set<int>> cameras_of_point;
  for (const int index : {cameras.first, cameras.second}) {
    const RealFrameCamera& camera = frame.cameras.at(static_cast<std::size_t>(index));
    const int own_index = static_cast<int>(pair.setup.cameras.size());
    CalibrationCamera& asked = pair.setup.cameras.emplace_back();
    asked.name = camera.name;
    asked.width_px = camera.width_px;
    asked.height_px = camera.height_px;
    pair.name += (own_index == 0 ? "" : "-") + std::to_string(index + 1);
    for (TargetObservation o : camera.sight.observations) {
      o.camera = own_index;
      pair.observations.push_back(o);
      cameras_of_point[o.point].insert(own_index);
    }
  }
  for (const auto& [point, seen_by] : cameras_of_point) {
    if (seen_by.size() == 2) pair.seen_by_both.push_back(point);
  }
  return pair;
}

}  // namespace

bool HasRealControlFrame() { return fs::exists(Folder()); }

RealControlFrame ObserveRealControlFrame() {
  RealControlFrame frame;
  frame.target = ReadTarget();
  for (const int index : {0, 1, 2}) frame.cameras.push_back(Observe(frame.target, index));
  return frame;
}

std::vector<RealPair> MakeRealPairs(const RealControlFrame& frame) {
  std::vector<RealPair> pairs;
  for (const auto& cameras : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
    pairs.push_back(MakePair(frame, cameras));
  }
  return pairs;
}

}  // namespace stereomotion::testing
