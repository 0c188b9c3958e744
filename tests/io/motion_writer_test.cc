#include "stereomotion/io/motion_writer.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io_test_support.h"

namespace stereomotion {
namespace {

using testing::Has;
using Json = nlohmann::json;

MotionAnalysis ThreeFrames() {
  MotionAnalysis analysis;
  analysis.series.resize(3);
  analysis.samples.resize(3);
  for (std::size_t i = 0; i < 3; ++i) {
    analysis.series[i].frame = static_cast<std::int64_t>(i);
    analysis.series[i].timestamp_ns = 10 * static_cast<std::int64_t>(i);
    analysis.series[i].measured = i != 1;
  }
  MotionSample& sample = analysis.samples[0];
  sample.status = sample.velocity.status = MotionStatus::kOk;
  sample.velocity.omega_rad_s = {1, -0.0, 1.0 / 3};
  sample.velocity.covariance.setIdentity();
  analysis.samples[2] = sample;
  SpinCenter center;
  center.law = PathLaw::kUniform;
  center.in_body_mm = {1, 2, 3};
  center.covariance_mm2.setIdentity();
  center.states.resize(3);
  center.states[1].position_mm = {7, 8, 9};
  analysis.spin.law = PathLaw::kUniform;
  analysis.spin.laws = {{PathLaw::kFixed, 30, 10, 40, false, {}},
                        {PathLaw::kUniform, 11, 10, 22, true, center},
                        {PathLaw::kFree, 40, 10, 60, true, {}}};
  analysis.spin.center = center;
  return analysis;
}

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines(1);
  for (const char c : text) {
    if (c == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += c;
    }
  }
  lines.pop_back();
  return lines;
}

// The contract's header, letter by letter.
TEST(MotionCsv, Columns) {
  const auto lines = Lines(MotionCsv(ThreeFrames()));
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0],
            "frame,timestamp_ns,wx_rad_s,wy_rad_s,wz_rad_s,vx_mm_s,vy_mm_s,vz_mm_s,u_wx,u_wy,u_wz,"
            "u_vx,u_vy,u_vz,center_x_mm,center_y_mm,center_z_mm,u_center_x,u_center_y,u_center_z,"
            "status,alphax_rad_s2,alphay_rad_s2,alphaz_rad_s2,accx_mm_s2,accy_mm_s2,accz_mm_s2,"
            "u_alphax,u_alphay,u_alphaz,u_accx,u_accy,u_accz,ucal_center_x,ucal_center_y,"
            "ucal_center_z");
  EXPECT_EQ(lines[1], "0,0,1,0,0.3333333333,0,0,0,1,1,1,1,1,1,,,,,,,ok,,,,,,,,,,,,,,,");
  EXPECT_EQ(lines[2], "1,10,,,,,,,,,,,,,,,,,,,gap,,,,,,,,,,,,,,,");
}

TEST(MotionJson, KeysOfTheContract) {
  const Json json = Json::parse(MotionJson(ThreeFrames()));
  EXPECT_EQ(json["format"], "stereomotion-motion/1");
  const Json& spin = json["spin_center"];
  EXPECT_EQ(spin["law"], "uniform");
  EXPECT_EQ(spin["in_body_mm"], Json({1, 2, 3}));
  EXPECT_EQ(spin["in_world_mm"], Json({7, 8, 9}));
  EXPECT_EQ(spin["covariance_mm2"][1], Json({0, 1, 0}));
  EXPECT_TRUE(spin["free_axis_in_body"].is_null());
  EXPECT_TRUE(spin["calibration_covariance_mm2"].is_null());
  EXPECT_EQ(spin["law_evidence"]["fixed"]["bic"], 40);
  EXPECT_EQ(spin["law_evidence"]["uniform"]["chi2"], 11);
  EXPECT_EQ(spin["law_evidence"]["free"]["dof"], 10);
  EXPECT_TRUE(spin["laws"]["fixed"].is_null());
  EXPECT_TRUE(json["axis"].is_null());
  EXPECT_TRUE(json["time_offset_s"].is_null());
  EXPECT_TRUE(json.contains("time_offset_u_s"));
  EXPECT_EQ(json["rotation"]["total_rad"], 0);
  EXPECT_EQ(json["noise_scale"], 2);
}

TEST(MotionJson, NoCenterIsNull) {
  MotionAnalysis analysis = ThreeFrames();
  analysis.spin.center.reset();
  analysis.spin.law = PathLaw::kFree;
  const Json spin = Json::parse(MotionJson(analysis))["spin_center"];
  EXPECT_EQ(spin["law"], "free");
  EXPECT_TRUE(spin["in_body_mm"].is_null());
  EXPECT_TRUE(spin["in_world_mm"].is_null());
}

TEST(FilteredCsv, EveryRowHasAllColumns) {
  FilteredSeries filtered;
  filtered.samples.resize(2);
  filtered.samples[0].status = MotionStatus::kFilled;
  const SpinCenter center;
  for (const SpinCenter* given : {static_cast<const SpinCenter*>(nullptr), &center}) {
    const auto lines = Lines(FilteredCsv(filtered, given));
    ASSERT_EQ(lines.size(), 3U);
    const auto commas = std::count(lines[0].begin(), lines[0].end(), ',');
    EXPECT_EQ(std::count(lines[1].begin(), lines[1].end(), ','), commas);
    EXPECT_EQ(std::count(lines[2].begin(), lines[2].end(), ','), commas);
    EXPECT_TRUE(Has(lines[1], ",filled,"));
  }
}

TEST(AnglesCsv, LockedTellsTheMiddleAngleOnly) {
  PoseSeries series(2);
  std::vector<PoseAngles> angles(2);
  angles[0].measured = angles[0].locked = true;
  angles[0].angles_rad = {1, 1.5, 2};
  const auto lines = Lines(AnglesCsv(series, angles, {"a", "b", "c"}));
  EXPECT_EQ(lines[0], "frame,timestamp_ns,status,a_rad,b_rad,c_rad,u_a_rad,u_b_rad,u_c_rad");
  EXPECT_EQ(lines[1], "-1,0,locked,,1.5,,,0,");
  EXPECT_EQ(lines[2], "-1,0,gap,,,,,,");
}

}  // namespace
}  // namespace stereomotion
