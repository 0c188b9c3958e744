#include "stereomotion/io/calibration_report.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>

#include "stereomotion/calibration/calibrate.h"
#include "tests/support/calibration_scene.h"
#include "tests/support/test_rng.h"
#include "xml_check.h"

namespace stereomotion {
namespace {

using nlohmann::json;
using testing::FindXmlError;
using testing::MakeTestRng;
using testing::XmlText;

struct Case {
  CalibrationSetup setup;
  Calibration calibration;
  CalibrationInputs inputs;
};

CalibrationInputs MakeInputs(const CalibrationSetup& setup, std::size_t views) {
  CalibrationInputs inputs;
  inputs.version = "1.2.3";
  inputs.command = {"stereomotion", "calibrate", "frame.yaml"};
  inputs.date = "2024-05-01T12:00:00Z";
  inputs.files = {{"frame", "frame.yaml", std::string(64, 'a')}, {"image", "cam0/0.png", ""}};
  for (const auto& camera : setup.cameras) {
    inputs.images.emplace_back();
    for (std::size_t v = 0; v < views; ++v) {
      inputs.images.back().push_back(camera.name + "/" + std::to_string(v) + ".png");
    }
    inputs.blur_px.emplace_back(views, 0.81);
  }
  return inputs;
}

Case Solve(testing::CalibrationScene scene, std::mt19937_64& rng) {
  if (!IsBoard(scene.setup.target.type)) scene.setup.check_points = {2, 5, 11};
  auto draw = testing::Draw(scene, rng);
  for (std::size_t i = 20; i < draw.observations.size() && i < 120; i += 45) {
    draw.observations[i].pixel_px.x() += 9;  // three outliers, far beyond noise
  }
  CalibrateOptions options;
  options.image_sigma_known = !IsBoard(scene.setup.target.type);
  const auto solved = Calibrate(draw.setup, draw.observations, options);
  if (!solved) throw std::runtime_error(solved.error().text);
  return {draw.setup, *solved, MakeInputs(draw.setup, scene.world_from_target.size())};
}

Case ControlPoints() {
  auto rng = MakeTestRng();
  return Solve(testing::MakeControlPointScene(40, 0.1, 2), rng);
}

std::string Html(const Case& c) { return CalibrationHtml(c.calibration, c.setup, c.inputs); }
json Data(const Case& c) { return json::parse(CalibrationJson(c.calibration, c.setup, c.inputs)); }

void ExpectSound(const std::string& html) {
  EXPECT_EQ(FindXmlError(html), "");
  static const std::regex undefined(R"(\b(nan|inf|infinity)\b)", std::regex::icase);
  std::smatch match;
  EXPECT_FALSE(std::regex_search(html, match, undefined)) << match.prefix().str().substr(0, 1);
  EXPECT_EQ(html.find("<script"), std::string::npos);
  static const std::regex external(R"((href|src)=|@import|url\((?!#)|="https?://(?!www\.w3\.org))");
  EXPECT_FALSE(std::regex_search(html, external));
}

bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(CalibrationReport, TellsEverything) {
  const Case c = ControlPoints();
  const std::string html = Html(c), text = XmlText(html);
  ExpectSound(html);
  ASSERT_FALSE(c.calibration.warnings.empty());
  for (const auto& note : c.calibration.warnings) {
    EXPECT_TRUE(Has(html, "<code>" + note.name + "</code>")) << note.name;
    EXPECT_TRUE(Has(text, note.text)) << note.text;
  }
  int outliers = 0;
  const std::string table = html.substr(html.find("<h2>Outliers"));
  for (const auto& r : c.calibration.residuals) {
    if (r.used) continue;
    ++outliers;
    EXPECT_TRUE(Has(table, "<code>" + c.setup.target.points[r.point].id + "</code>"));
  }
  EXPECT_GE(outliers, 3);
  for (const int point : c.setup.check_points) {
    EXPECT_TRUE(Has(html, "<code>" + c.setup.target.points[point].id + "</code></td><td"));
  }
  for (const std::string part : {"Residual vectors of cam1", "Coverage of cam0",
                                 "z = ", "5-fold cross-validation", "cam1/1.png", "0.81", "1.2.3",
                                 "2024-05-01T12:00:00Z", "stereomotion calibrate frame.yaml"}) {
    EXPECT_TRUE(Has(html, part)) << part;
  }
  EXPECT_TRUE(Has(html, std::string(64, 'a')));
}

TEST(CalibrationReport, JsonHoldsTheNumbers) {
  const Case c = ControlPoints();
  const Calibration& k = c.calibration;
  const json j = Data(c);
  EXPECT_EQ(j["format"], "stereomotion-calibration/1");
  EXPECT_EQ(j["rms_px"].get<double>(), k.rms_px);
  EXPECT_EQ(j["chi2_dof"].get<double>(), k.chi2_dof);
  EXPECT_EQ(j["cross_validation"]["rms_mm"].get<double>(), k.cross_validation->rms_mm);
  EXPECT_EQ(j["cameras"][1]["fx_px"].get<double>(), k.rig.cameras[1].model.fx_px);
  EXPECT_TRUE(j["inputs"][1]["sha256"].is_null());
  ASSERT_EQ(j["residuals"]["rows"].size(), k.residuals.size());
  double sum_px2 = 0;
  int used = 0, left_out = 0;
  for (std::size_t i = 0; i < k.residuals.size(); ++i) {
    const json& row = j["residuals"]["rows"][i];
    EXPECT_EQ(row[3].get<double>(), k.residuals[i].pixel_px.x());
    EXPECT_EQ(row[6].get<double>(), k.residuals[i].residual_px.y());
    EXPECT_EQ(row[8].get<bool>(), k.residuals[i].used);
    ++(row[8].get<bool>() ? used : left_out);
    const double du_px = row[5], dv_px = row[6];
    if (row[8].get<bool>()) sum_px2 += du_px * du_px + dv_px * dv_px;
  }
  EXPECT_NEAR(std::sqrt(sum_px2 / (2 * used)), k.rms_px, 1e-12 * k.rms_px);
  EXPECT_EQ(j["outliers"].size(), static_cast<std::size_t>(left_out));
  EXPECT_EQ(j["warnings"].size(), k.warnings.size());
  EXPECT_EQ(j["volume"]["rows"].size(), k.volume.size());
  EXPECT_EQ(j["volume"]["rows"][7][4].get<double>(), k.volume[7].calibration_mm);
  const Eigen::MatrixXd& covariance = k.rig.covariance->matrix;
  ASSERT_EQ(j["parameters"]["names"], json(k.free_parameters));
  for (Eigen::Index a = 0; a < covariance.rows(); ++a) {
    for (Eigen::Index b = 0; b < covariance.cols(); ++b) {
      const double r = j["parameters"]["correlation"][a][b];
      const double sigmas =
          j["parameters"]["sigma"][a].get<double>() * j["parameters"]["sigma"][b].get<double>();
      EXPECT_NEAR(r * sigmas, covariance(a, b), 1e-12 * sigmas);
    }
  }
}

TEST(CalibrationReport, CheckPointInSigmas) {
  Case c = ControlPoints();
  CheckPoint check;
  check.point = 2;
  check.error_mm = {0.3, -0.4, 1.2};
  check.covariance_mm2 = Eigen::Vector3d(0.01, 0.04, 0.09).asDiagonal();
  c.calibration.check_points = {check};
  // Independent errors of 3, 2 and 4 standard deviations.
  EXPECT_NEAR(Data(c)["check_points"][0]["in_sigmas"].get<double>(), std::sqrt(29.0), 1e-12);
  EXPECT_NEAR(Data(c)["verdict"]["check_points_rms_mm"].get<double>(), 1.3, 1e-12);
  EXPECT_NEAR(Data(c)["verdict"]["check_points_predicted_rms_mm"].get<double>(), std::sqrt(0.14),
              1e-12);
  c.calibration.check_points[0].covariance_mm2.setZero();
  EXPECT_TRUE(Data(c)["check_points"][0]["in_sigmas"].is_null());
  ExpectSound(Html(c));
}

TEST(CalibrationReport, Boards) {
  auto rng = MakeTestRng();
  const Case c = Solve(testing::MakeBoardScene(8), rng);
  ExpectSound(Html(c));
  EXPECT_TRUE(Has(Html(c), "an AprilTag grid (5 × 6) in 8 of 8 views"));
  EXPECT_TRUE(Data(c)["cross_validation"].is_null());
  EXPECT_FALSE(Has(Html(c), "<h2>Check points"));
}

TEST(CalibrationReport, EscapesForeignText) {
  Case c = ControlPoints();
  const std::string nasty = "<script>alert('x')</script>&\"\x01\xff]]>";
  for (auto& point : c.setup.target.points) point.id = nasty;
  for (auto* name : {&c.setup.cameras[0].name, &c.calibration.rig.cameras[0].name,
                     &c.inputs.files[0].path, &c.inputs.files[0].role, &c.inputs.command[1],
                     &c.inputs.images[0][0], &c.inputs.version, &c.inputs.date}) {
    *name = nasty;
  }
  c.calibration.warnings = {{nasty, nasty}};
  ExpectSound(Html(c));
  EXPECT_TRUE(Has(XmlText(Html(c)), "<script>alert('x')</script>&\""));
  EXPECT_EQ(Data(c)["cameras"][0]["name"], "<script>alert('x')</script>&\"\x01\xEF\xBF\xBD]]>");
}

}  // namespace
}  // namespace stereomotion
