#include "stereomotion/io/run_report.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stereomotion/geometry/so3.h"
#include "xml_check.h"

namespace stereomotion::testing {
namespace {

bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class RunReportTest : public ::testing::Test {
 protected:
  RunReportTest() {
    body_.rods = {{"A", 14, {{0, 0, 0}, {40, 0, 0}, {90, 0, 0}}, 0}};
    left_.name = record_.left_camera = "cam<0>";
    right_.name = record_.right_camera = "cam1";
    left_.width_px = right_.width_px = 640;
    left_.height_px = right_.height_px = 512;
    record_.detector = "ml";
  }
  PairMeasurement Pair(std::int64_t frame, bool has_pose = true) const {
    PairMeasurement pair;
    pair.frame = frame;
    pair.timestamp_ns = 1'000'000'000 + frame * 10'000'000;
    MatchedDetection detection;
    detection.observation.center_px = {100 + 0.01 * static_cast<double>(frame), 200};
    pair.left = pair.right = {detection};
    if (!has_pose) return pair;
    pair.pose.emplace();
    pair.pose->world_from_body = {ExpSO3({0, 0, 0.01 * static_cast<double>(frame)}),
                                  {static_cast<double>(frame), 0, 5}};
    pair.pose->covariance = 1e-4 * Matrix6d::Identity();
    pair.pose->rms_px = 0.004;
    return pair;
  }
  std::string Html(const RunTrace& trace) const {
    return RunHtml({record_, {{&trace, nullptr}}, left_, right_, masks_});
  }

  Body body_;
  RunRecord record_;
  RigCamera left_, right_;
  std::vector<CameraMask> masks_;
};

TEST_F(RunReportTest, WellFormedAndComplete) {
  RunTrace trace(body_);
  for (int i = 0; i < 50; ++i) trace.Add(Pair(i, i != 20));
  record_.summary.pairs_read = 50;
  record_.summary.poses = 49;
  record_.summary.lost_by_reason["lost"] = 1;
  record_.summary.median_chi2_dof = 1.02;
  record_.summary.warnings = {"a <b> & c"};
  masks_ = {{"cam<0>", {{{{10, 10}, {50, 10}, {50, 60}}, ""}}}};
  const std::string html = Html(trace);
  EXPECT_EQ(FindXmlError(html), "");
  const std::string text = XmlText(html);
  EXPECT_TRUE(Has(text, "found in 49 of 50 frame pairs (98.0 %)"));
  EXPECT_TRUE(Has(html, "usable_with_warnings"));
  EXPECT_TRUE(Has(html, "a &lt;b&gt; &amp; c"));
  EXPECT_TRUE(Has(html, "class=\"mask\""));
  EXPECT_TRUE(Has(html, "class=\"lost\""));
  EXPECT_FALSE(Has(html, "nan"));
}

TEST_F(RunReportTest, TwoBodiesWithTheirMotion) {
  RunTrace trace(body_), other(body_);
  MotionAnalysis motion;
  for (int i = 0; i < 20; ++i) {
    trace.Add(Pair(i));
    other.Add(Pair(i, i >= 15));
    motion.series.emplace_back().timestamp_ns = i * 10'000'000;
    MotionSample& sample = motion.samples.emplace_back();
    sample.status = i == 7 ? MotionStatus::kGap : MotionStatus::kOk;
    sample.velocity.covariance.setIdentity();
  }
  motion.spin.verdict = "range of rotation 11 degrees <known>";
  motion.spin.center.emplace().free_axis_in_body = Eigen::Vector3d::UnitZ();
  motion.spin.center->states.resize(20);
  motion.axis.emplace().axis.in_world = Eigen::Vector3d::UnitZ();
  motion.axis->point_in_world_mm = {1, 2, 3};
  motion.spin.laws.resize(1);
  record_.summary.pairs_read = 20;
  record_.summary.bodies = {{"thigh <l>", 20, {}, 1.0, 1}, {"shank", 5, {{"lost", 15}}, 1.0, 1}};
  const std::string html =
      RunHtml({record_, {{&trace, &motion}, {&other, nullptr}}, left_, right_, masks_});
  EXPECT_EQ(FindXmlError(html), "");
  EXPECT_TRUE(Has(html, "verdict doubtful"));  // the worse of the two
  EXPECT_TRUE(Has(html, "thigh &lt;l&gt;: the pose was found in 20 of 20"));
  EXPECT_TRUE(Has(html, "shank: the pose was found in 5 of 20"));
  EXPECT_TRUE(Has(html, "degrees &lt;known&gt;"));
  EXPECT_TRUE(Has(html, "thigh &lt;l&gt;: Motion"));
  EXPECT_FALSE(Has(html, "shank: Motion"));
  EXPECT_TRUE(Has(html, "Angular velocity"));
  EXPECT_TRUE(Has(html, "free along"));
  EXPECT_FALSE(Has(html, ">nan"));
}

// A rod's turn about itself is not seen: ω normal to it is all that is drawn, as in motion.csv.
TEST_F(RunReportTest, RodShowsNoOpenVelocity) {
  RunTrace trace(body_);
  MotionAnalysis motion;
  for (int i = 0; i < 5; ++i) {
    trace.Add(Pair(i));
    motion.series.emplace_back().timestamp_ns = i * 10'000'000;
    MotionSample& sample = motion.samples.emplace_back();
    sample.status = MotionStatus::kOk;
    sample.velocity.covariance.setIdentity();
    sample.velocity.open_axis_in_world = Eigen::Vector3d(1, 1, 0).normalized();
  }
  motion.warnings = {"its roll <is> open"};
  const auto html = [&] { return RunHtml({record_, {{&trace, &motion}}, left_, right_, masks_}); };
  record_.summary.pairs_read = record_.summary.poses = 5;
  EXPECT_EQ(FindXmlError(html()), "");
  EXPECT_TRUE(Has(html(), "Angular velocity"));
  EXPECT_TRUE(Has(html(), "<li>its roll &lt;is&gt; open</li>"));
  EXPECT_TRUE(Has(html(), "verdict usable_with_warnings"));
  for (MotionSample& sample : motion.samples) {
    sample.velocity.open_axis_in_world = Eigen::Vector3d(1, 1, 1).normalized();
  }
  EXPECT_FALSE(Has(html(), "Angular velocity"));
  EXPECT_TRUE(Has(html(), "No component of the angular velocity is determined"));
}

TEST_F(RunReportTest, NothingToShow) {
  const RunTrace trace(body_);
  const std::string html = Html(trace);
  EXPECT_EQ(FindXmlError(html), "");
  EXPECT_TRUE(Has(html, "No pose was found"));
}

TEST_F(RunReportTest, Verdicts) {
  RunTrace trace(body_);
  trace.Add(Pair(0));
  record_.summary.pairs_read = record_.summary.poses = 100;
  EXPECT_TRUE(Has(Html(trace), "verdict good"));
  record_.summary.poses = 94;
  EXPECT_TRUE(Has(Html(trace), "verdict usable_with_warnings"));
  record_.summary.poses = 49;
  EXPECT_TRUE(Has(Html(trace), "verdict doubtful"));
  record_.summary.poses = 100;
  record_.summary.median_chi2_dof = 1.45;
  EXPECT_TRUE(Has(Html(trace), "verdict good"));
  record_.summary.median_chi2_dof = 1.55;
  EXPECT_TRUE(Has(Html(trace), "verdict usable_with_warnings"));
  EXPECT_TRUE(Has(Html(trace), "larger than the stated σ"));
  record_.summary.median_chi2_dof = 2.1;
  EXPECT_TRUE(Has(Html(trace), "verdict doubtful"));
  record_.summary.chi2_dof_by_chance = 2.2;  // of a few poses
  EXPECT_TRUE(Has(Html(trace), "verdict good"));
}

TEST_F(RunReportTest, NumbersInWords) {
  RunTrace trace(body_);
  trace.Add(Pair(0));
  record_.summary.pairs_read = record_.summary.poses = 1;
  record_.search_every = 3;
  record_.command = {"track", "--left", "my cam", "it's", ""};
  masks_ = {{"cam1", {{{{-10, 10}, {50, 10}, {50, 60}}, ""}}}};
  const std::string html = Html(trace);
  EXPECT_EQ(FindXmlError(html), "");
  EXPECT_TRUE(Has(html, "found in 1 of 1 frame pair ("));
  EXPECT_TRUE(Has(html, "Every 3rd pair"));
  EXPECT_TRUE(Has(XmlText(html), "track --left 'my cam' 'it'\\''s' ''")) << XmlText(html);
  EXPECT_TRUE(Has(html, "clip-path=\"url(#image1)\""));
  EXPECT_TRUE(Has(html, "m-2 0h4"));  // the only pose shows
}

TEST_F(RunReportTest, LongRunsAreThinnedEvenly) {
  RunTrace trace(body_);
  for (int i = 0; i < 20000; ++i) trace.Add(Pair(i));
  ASSERT_GT(trace.points().size(), 900U);
  ASSERT_LT(trace.points().size(), 2000U);
  for (std::size_t i = 0; i < trace.points().size(); ++i) {
    EXPECT_EQ(trace.points()[i].frame, trace.point_every() * static_cast<std::int64_t>(i));
  }
  EXPECT_LT(trace.dots(0).size(), 6000U);
  EXPECT_EQ(trace.blobs(0).at("ok"), 20000);
  EXPECT_LT(Html(trace).size(), 800'000U);
}

/// σ of the balls' middle: δt − (R arm) × δθ, at the middle of (0, 40, 90) mm.
TEST_F(RunReportTest, SigmaOfTheMiddleOfTheBalls) {
  RunTrace trace(body_);
  trace.Add(Pair(0));
  const double arm_mm = 130.0 / 3;
  const Eigen::Vector3d expected_mm(0.01, 0.01 * std::hypot(1, arm_mm),
                                    0.01 * std::hypot(1, arm_mm));
  EXPECT_LT((trace.points()[0].centroid_sigma_mm - expected_mm).norm(), 1e-9);
  EXPECT_LT((trace.points()[0].centroid_in_world_mm - Eigen::Vector3d(arm_mm, 0, 5)).norm(), 1e-9);
}

}  // namespace
}  // namespace stereomotion::testing
