#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <locale>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "stereomotion/io/calibration_report.h"
#include "tests/support/calibration_scene.h"
#include "tests/support/test_rng.h"
#include "xml_check.h"

namespace stereomotion {
namespace {

using nlohmann::json;
using testing::FindXmlError;
using testing::MakeTestRng;

struct Case {
  CalibrationSetup setup;
  Calibration calibration;
};

// A chessboard of 120 corners all over both images: what a big calibration holds, not solved.
Case Big(int views) {
  auto rng = MakeTestRng();
  Case c;
  c.setup.target.type = TargetType::kChessboard;
  c.setup.target.rows = 10;
  c.setup.target.cols = 12;
  c.setup.target.spacing_mm = 20;
  c.setup.target.points = MakeBoardPoints(c.setup.target);
  c.calibration.rig = testing::MakeCalibrationRig();
  for (const auto& camera : c.calibration.rig.cameras) {
    c.setup.cameras.push_back({camera.name, "", camera.width_px, camera.height_px, {}, {}});
  }
  c.calibration.world_from_target.resize(views);
  c.calibration.view_used.assign(views, true);
  for (int i = 0; i < 2 * views * 120; ++i) {
    CalibrationResidual r{i % 2, i / 240, i / 2 % 120};
    r.pixel_px = {testing::Uniform(rng, 0, 1279), testing::Uniform(rng, 0, 1023)};
    r.residual_px = 0.05 * testing::NormalVector<2>(rng);
    r.used = i % 25 != 0;
    c.calibration.residuals.push_back(r);
  }
  return c;
}

std::string Html(const Case& c) { return CalibrationHtml(c.calibration, c.setup, {}); }
std::string Text(const Case& c) { return CalibrationJson(c.calibration, c.setup, {}); }
bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(CalibrationPage, BigCalibrationStaysSmall) {
  const std::string html = Html(Big(100));
  EXPECT_LT(html.size(), 3'000'000U);
  EXPECT_EQ(FindXmlError(html), "");
  EXPECT_TRUE(Has(html, "of 11520 is drawn"));  // 12 000 a camera, of one camera each 12.5th is out
}

TEST(CalibrationPage, EmptyCalibrationIsAPage) {
  Case c = Big(0);
  EXPECT_EQ(FindXmlError(Html(c)), "");
  const json j = json::parse(Text(c));
  EXPECT_TRUE(j["cameras"][0]["rms_px"].is_null());
  EXPECT_TRUE(j["verdict"]["volume_random_mm"].is_null());
  EXPECT_TRUE(j["version"].is_null());
}

TEST(CalibrationPage, NothingUndefinedIsWritten) {
  Case c = Big(3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  c.calibration.residuals[1].residual_px.x() = nan;
  c.calibration.residuals[2].pixel_px.y() = std::numeric_limits<double>::infinity();
  c.calibration.chi2_dof = nan;
  c.calibration.volume = {{{0, 0, nan}, 1, 1}, {{0, 0, 0}, nan, 1}, {{5, 0, 0}, 1, 0}};
  c.calibration.rig.covariance =
      RigCovariance{{{0, 0}, {1, 0}}, Eigen::Vector2d(0, 4).asDiagonal()};
  const std::string html = Html(c);
  EXPECT_EQ(FindXmlError(html), "");
  for (const char* word : {"nan", "NaN", ">inf", " inf", "-inf"})
    EXPECT_FALSE(Has(html, word)) << word;
  const json j = json::parse(Text(c));
  EXPECT_TRUE(j["chi2_dof"].is_null());
  EXPECT_TRUE(j["residuals"]["rows"][1][5].is_null());
}

class GermanNumbers : public std::numpunct<char> {
  [[nodiscard]] char do_decimal_point() const override { return ','; }
  [[nodiscard]] char do_thousands_sep() const override { return '.'; }
  [[nodiscard]] std::string do_grouping() const override { return "\3"; }
};

TEST(CalibrationPage, EqualInputGivesEqualBytes) {
  const Case c = Big(4);
  const std::string before = Html(c) + Text(c);
  const std::locale classic =
      std::locale::global(std::locale(std::locale::classic(), new GermanNumbers));
  const std::string after = Html(Big(4)) + Text(Big(4));
  std::locale::global(classic);
  EXPECT_EQ(after, before);
}

TEST(CalibrationPage, VerdictFollowsWarningsAndHeldOutErrors) {
  Case c = Big(4);
  for (auto& r : c.calibration.residuals) r.used = true;
  const auto level = [&] { return json::parse(Text(c))["verdict"]["level"].get<std::string>(); };
  EXPECT_EQ(level(), "good");
  c.calibration.cross_validation = CrossValidation{5, 20, 0.11, 0.1};
  EXPECT_EQ(level(), "good");
  c.calibration.residuals[0].used = false;  // 1 of 960
  c.calibration.warnings = {{"outliers", ""}};
  EXPECT_EQ(level(), "good");
  for (int i = 0; i < 40; ++i) c.calibration.residuals[i].used = false;  // 4 %
  EXPECT_EQ(level(), "usable_with_warnings");
  c.calibration.warnings.clear();
  c.calibration.cross_validation->rms_mm = 0.2;
  EXPECT_EQ(level(), "usable_with_warnings");
  c.calibration.cross_validation->rms_mm = 0.3;
  EXPECT_EQ(level(), "usable_with_warnings");  // it may be the outliers, which are compared, too
  for (auto& r : c.calibration.residuals) r.used = true;
  EXPECT_EQ(level(), "doubtful");
  c.calibration.cross_validation.reset();
  c.calibration.warnings = {{"systematic_residuals", ""}};
  EXPECT_EQ(level(), "doubtful");
}

TEST(CalibrationPage, MarksOutlyingViews) {
  Case c = Big(6);
  for (auto& r : c.calibration.residuals) {
    r.used = true;
    if (r.camera == 1 && r.view == 4) r.residual_px *= 3;
  }
  const json j = json::parse(Text(c));
  for (int view = 0; view < 6; ++view) {
    EXPECT_FALSE(j["views"][view]["images"][0]["outlying"].get<bool>());
    EXPECT_EQ(j["views"][view]["images"][1]["outlying"].get<bool>(), view == 4);
  }
  EXPECT_TRUE(Has(Html(c), "outlying: cam1"));
}

TEST(CalibrationPage, RefusesWhatDoesNotBelongTogether) {
  Case c = Big(2);
  c.calibration.residuals[3].point = 120;
  EXPECT_THROW(Html(c), std::invalid_argument);
  c = Big(2);
  c.setup.cameras.pop_back();
  EXPECT_THROW(Text(c), std::invalid_argument);
  c = Big(2);
  c.calibration.rig.covariance = RigCovariance{{{0, 0}}, Eigen::Matrix2d::Identity()};
  EXPECT_THROW(Html(c), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
