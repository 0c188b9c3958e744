// Four cameras behind a window that refracts: no pinhole model fits, and the calibration says so.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "stereomotion/calibration/calibrate.h"
#include "tests/support/number_table.h"
#include "tests/support/recording_run.h"

namespace stereomotion::testing {
namespace {

namespace fs = std::filesystem;

constexpr int kCameras = 4;
constexpr std::size_t kHeldOut = 722;  // of 1805 markers

/// One way of dividing the markers into those of the fit and those held out.
struct Case {
  const char* name;
  /// A four-camera pinhole with distortion gives 0.69 and 1.00 (data/README.md): some 5 % more.
  double most_mm;
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

fs::path Folder() { return SharedData() / "real/lines_of_sight_proptv/cases"; }

using Place = std::array<double, 3>;

/// All markers with their images: what one case holds out stands in the other case's files.
class Markers {
 public:
  Markers() {
    setup_.target.type = TargetType::kControlPoints;
    for (int camera = 0; camera < kCameras; ++camera) {
      CalibrationCamera& asked = setup_.cameras.emplace_back();
      asked.name = "cam" + std::to_string(camera);
      asked.width_px = 2560;
      asked.height_px = 2160;
      for (const char* name : {"interpolation", "extrapolation"}) Add(name, camera);
    }
  }

  [[nodiscard]] CalibrationSetup SetupOf(const std::string& name) const {
    CalibrationSetup setup = setup_;
    const std::set<int>& fitted = fitted_.at(name);
    for (int point = 0; point < static_cast<int>(setup.target.points.size()); ++point) {
      if (fitted.count(point) == 0) setup.check_points.push_back(point);
    }
    return setup;
  }
  [[nodiscard]] const std::vector<TargetObservation>& observations() const { return observations_; }
  [[nodiscard]] int Find(const Place& place_mm) const { return point_at_.at(place_mm); }

 private:
  void Add(const std::string& name, int camera) {
    const std::string file = "markers_c" + std::to_string(camera) + ".txt";
    for (const auto& row : ReadNumbers(Folder() / ("case_" + name) / file)) {
      const Place place_mm = {row.at(2), row.at(3), row.at(4)};
      const auto next = static_cast<int>(point_at_.size());
      const auto [entry, is_new] = point_at_.emplace(place_mm, next);
      const int point = entry->second;
      if (is_new) {
        setup_.target.points.push_back({std::to_string(point), {row[2], row[3], row[4]}, 0});
      }
      fitted_[name].insert(point);
      if (!seen_.insert({camera, point}).second) continue;
      TargetObservation o{camera, 0, point, {row[0], row[1]}};
      o.covariance_px2 = Eigen::Matrix2d::Identity() / 12;  // the markers are whole pixels
      observations_.push_back(o);
    }
  }

  CalibrationSetup setup_;
  std::vector<TargetObservation> observations_;
  std::map<Place, int> point_at_;
  std::map<std::string, std::set<int>> fitted_;
  std::set<std::pair<int, int>> seen_;
};

double PeerRmsMm(const std::string& file, const Markers& markers,
                 const std::vector<int>& held_out) {
  const std::set<int> counted(held_out.begin(), held_out.end());
  double squared_mm2 = 0;
  std::size_t count = 0;
  for (const auto& row : ReadNumbers(Folder() / file)) {
    if (counted.count(markers.Find({row.at(0), row.at(1), row.at(2)})) == 0) continue;
    squared_mm2 += Eigen::Vector3d(row.at(3), row.at(4), row.at(5)).squaredNorm();
    ++count;
  }
  EXPECT_EQ(count, kHeldOut) << file;
  return std::sqrt(squared_mm2 / static_cast<double>(count));
}

double RmsMm(const std::vector<CheckPoint>& checks) {
  double squared_mm2 = 0;
  for (const CheckPoint& check : checks) squared_mm2 += check.error_mm.squaredNorm();
  return std::sqrt(squared_mm2 / static_cast<double>(checks.size()));
}

/// Names the cameras of which the calibration says that no lens model fits.
std::set<std::string> CamerasWithSystematicResiduals(const Calibration& calibration) {
  std::set<std::string> cameras;
  for (const auto& note : calibration.warnings) {
    if (note.name != "systematic_residuals") continue;
    EXPECT_NE(note.text.find("systematic residuals: refraction or a wrong lens model"),
              std::string::npos)
        << note.text;
    for (const RigCamera& camera : calibration.rig.cameras) {
      if (note.text.find(camera.name) != std::string::npos) cameras.insert(camera.name);
    }
  }
  return cameras;
}

class CalibrateLinesOfSight : public ::testing::TestWithParam<Case> {};

TEST_P(CalibrateLinesOfSight, SaysThatNoLensModelFits) {
  if (!fs::exists(Folder())) GTEST_SKIP() << Folder().string() << " is not here";
  const std::string name = GetParam().name;
  const Markers markers;
  const CalibrationSetup setup = markers.SetupOf(name);
  ASSERT_EQ(setup.check_points.size(), kHeldOut);
  CalibrateOptions options;
  options.image_sigma_known = false;
  options.folds = 0;
  const auto calibration = Calibrate(setup, markers.observations(), options);
  ASSERT_TRUE(calibration) << calibration.error().text;
  ASSERT_EQ(calibration->check_points.size(), kHeldOut);
  EXPECT_EQ(CamerasWithSystematicResiduals(*calibration).size(), kCameras);
  const double held_out_mm = RmsMm(calibration->check_points);
  EXPECT_LE(held_out_mm, GetParam().most_mm);
  RecordProperty("held_out_mm", std::to_string(held_out_mm));
  fmt::print("{}: 3D RMS on {} held-out markers {:.3f} mm; MyPTV-Tsai {:.3f}, MyPTV-Zolof {:.3f}\n",
             name, kHeldOut, held_out_mm,
             PeerRmsMm("MyPTV_Tsai_cal_error_" + name, markers, setup.check_points),
             PeerRmsMm("MyPTV_extendedZolof_cal_error_" + name, markers, setup.check_points));
  fmt::print("  residual RMS {:.2f} px per coordinate, image sigma x {:.2f}\n", calibration->rms_px,
             calibration->image_sigma_scale);
  for (const auto& note : calibration->warnings) {
    fmt::print("  {}: {:.160}\n", note.name, note.text);
  }
}

std::string NameOf(const ::testing::TestParamInfo<Case>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Cases, CalibrateLinesOfSight,
                         ::testing::Values(Case{"interpolation", 0.75},
                                           Case{"extrapolation", 1.05}),
                         NameOf);

}  // namespace
}  // namespace stereomotion::testing
