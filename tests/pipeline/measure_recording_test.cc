#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "stereomotion/pipeline/measure.h"
#include "tests/simulation/test_scenario.h"
#include "tests/support/simulated_pairs.h"

namespace stereomotion::testing {
namespace {

constexpr std::int64_t kPairs = 6;

/// Renders the pairs of this program once.
const std::vector<FramePair>& RenderedPairs() {
  static const std::vector<FramePair> pairs = [] {
    std::vector<FramePair> rendered(kPairs);
    for (std::int64_t i = 0; i < kPairs; ++i) {
      RenderPair(MakeTestScenario(), i, rendered[static_cast<std::size_t>(i)]);
    }
    return rendered;
  }();
  return pairs;
}

/// Repeats unreadable pairs, which cost no time, and reports every read.
class WatchedSource : public PairSource {
 public:
  using OnRead = std::function<void(std::int64_t position, const FramePair& pair)>;
  WatchedSource(std::int64_t size, OnRead on_read) : size_(size), on_read_(std::move(on_read)) {}
  [[nodiscard]] std::int64_t size() const override { return size_; }
  bool Read(std::int64_t position, FramePair& pair) const override {
    pair.left.index = pair.right.index = position;
    pair.left.problem = pair.right.problem = "left out";
    on_read_(position, pair);
    return true;
  }

 private:
  std::int64_t size_;
  OnRead on_read_;
};

class MeasureRecordingTest : public ::testing::Test {
 protected:
  MeasureRecordingTest() {
    const Scenario scenario = MakeTestScenario();
    setup_.rig = scenario.rig;
    setup_.bodies = {scenario.body};
    noise_ = scenario.sensor.noise();
    options_.threads = 2;
  }
  void GiveNoise() {
    for (RigCamera& camera : setup_.rig.cameras) camera.noise = noise_;
  }
  RunSummary Measure(const PairSource& source, const std::atomic<bool>* stop = nullptr) {
    measurements_.clear();
    const MeasurementSink sink = [this](const PairMeasurement& measurement) {
      measurements_.push_back(measurement);
      return !on_pair_ || on_pair_(measurement);
    };
    return MeasureRecording(source, setup_, options_, sink, stop);
  }
  RunSummary Measure(std::vector<FramePair> pairs) {
    return Measure(StoredPairs(std::move(pairs)));
  }

  MeasureSetup setup_;
  MeasureOptions options_;
  SensorNoise noise_;
  MeasurementSink on_pair_;
  std::vector<PairMeasurement> measurements_;
};

bool AnyContains(const std::vector<std::string>& texts, const std::string& part) {
  return std::any_of(texts.begin(), texts.end(),
                     [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

TEST_F(MeasureRecordingTest, MeasuresEveryPair) {
  const RunSummary summary = Measure(RenderedPairs());
  EXPECT_EQ(summary.pairs_read, kPairs);
  EXPECT_EQ(summary.poses, kPairs);
  EXPECT_TRUE(summary.lost_by_reason.empty());
  EXPECT_FALSE(summary.interrupted);
  ASSERT_EQ(measurements_.size(), static_cast<std::size_t>(kPairs));
  const Scenario scenario = MakeTestScenario();
  for (std::int64_t i = 0; i < kPairs; ++i) {
    const PairMeasurement& measurement = measurements_[static_cast<std::size_t>(i)];
    const FrameTime time = TimeOfFrame(scenario, 0, i);
    const Rigid3 truth = StateAt(scenario.motion, time.true_s).world_from_body;
    EXPECT_EQ(measurement.frame, i);
    EXPECT_EQ(measurement.timestamp_ns, time.timestamp_ns);
    EXPECT_EQ(measurement.balls.size(), 10U);
    ASSERT_TRUE(measurement.pose) << i;
    EXPECT_FALSE(measurement.pose->calibration_u);
    const Vector6d error = PerturbationBetween(truth, measurement.pose->world_from_body);
    const Vector6d sigma = measurement.pose->covariance.diagonal().cwiseSqrt();
    EXPECT_LT(error.cwiseQuotient(sigma).cwiseAbs().maxCoeff(), 5) << i;
  }
}

TEST_F(MeasureRecordingTest, KeepsTheOrderOnAnyNumberOfThreads) {
  GiveNoise();
  options_.threads = 4;
  // The earlier of four pairs takes longer, so that they finish in the wrong order.
  const WatchedSource source(40, [](std::int64_t position, const FramePair&) {
    std::this_thread::sleep_for(std::chrono::milliseconds(4 * (3 - position % 4)));
  });
  EXPECT_EQ(Measure(source).pairs_read, 40);
  for (std::size_t i = 0; i < measurements_.size(); ++i) {
    EXPECT_EQ(measurements_[i].frame, static_cast<std::int64_t>(i));
  }
}

TEST_F(MeasureRecordingTest, MeasuresTheWantedPart) {
  options_.first = 2;
  options_.count = 3;
  EXPECT_EQ(Measure(RenderedPairs()).pairs_read, 3);
  EXPECT_EQ(measurements_.front().frame, 2);
  options_.count = 100;
  EXPECT_EQ(Measure(RenderedPairs()).pairs_read, kPairs - 2);
}

TEST_F(MeasureRecordingTest, SourceThatThrows) {
  const auto throws = [](std::int64_t position, const FramePair&) {
    if (position == 20) throw std::runtime_error("the disk is gone");
  };
  for (const int threads : {1, 3}) {
    options_.threads = threads;
    EXPECT_THROW(Measure(WatchedSource(50, throws)), std::runtime_error);  // learning the noise
    GiveNoise();
    EXPECT_THROW(Measure(WatchedSource(50, throws)), std::runtime_error);
    EXPECT_LE(measurements_.size(), 20U);
    for (RigCamera& camera : setup_.rig.cameras) camera.noise.reset();
  }
}

TEST_F(MeasureRecordingTest, StopFlagEndsAfterThePairsInHand) {
  GiveNoise();
  std::atomic<bool> stop{false};
  on_pair_ = [&](const PairMeasurement& measurement) {
    stop = measurement.frame == 2;
    return true;
  };
  const RunSummary summary =
      Measure(WatchedSource(1000, [](std::int64_t, const FramePair&) {}), &stop);
  // The sink is two pairs behind: those were tracked and are not lost.
  EXPECT_EQ(summary.pairs_read, 5);
  EXPECT_EQ(measurements_.size(), 5U);
  EXPECT_TRUE(summary.interrupted);
}

TEST_F(MeasureRecordingTest, SinkEndsTheRun) {
  GiveNoise();
  on_pair_ = [](const PairMeasurement& measurement) { return measurement.frame < 2; };
  const RunSummary summary = Measure(WatchedSource(1000, [](std::int64_t, const FramePair&) {}));
  EXPECT_EQ(summary.pairs_read, 3);
  EXPECT_FALSE(summary.interrupted);
}

TEST_F(MeasureRecordingTest, BadFramesSayWhyAndTheRunGoesOn) {
  std::vector<FramePair> pairs = RenderedPairs();
  pairs[1].left.image = {};
  pairs[1].left.problem = "cam0/000001.png: truncated";
  pairs[2].right.image.Resize(100, 80, PixelType::kGray8);
  pairs[3].right = {};  // no partner
  const RunSummary summary = Measure(pairs);
  ASSERT_EQ(measurements_.size(), static_cast<std::size_t>(kPairs));
  EXPECT_EQ(measurements_[1].status, PoseStatus::kUnreadable);
  EXPECT_EQ(measurements_[1].detail, "cam0/000001.png: truncated");
  EXPECT_EQ(measurements_[2].status, PoseStatus::kUnreadable);
  EXPECT_NE(measurements_[2].detail.find("100 x 80"), std::string::npos) << measurements_[2].detail;
  EXPECT_EQ(measurements_[3].status, PoseStatus::kNoPair);
  for (const std::size_t good : {0, 4, 5}) {
    EXPECT_EQ(measurements_[good].status, PoseStatus::kOk) << good;
    EXPECT_EQ(measurements_[good].detail, "");
  }
  for (const std::size_t bad : {1, 2, 3}) {
    EXPECT_FALSE(measurements_[bad].pose) << bad;
    EXPECT_EQ(measurements_[bad].balls.size(), 10U);
    EXPECT_EQ(measurements_[bad].balls.front().status, BallStatus::kNoPose);
  }
  EXPECT_EQ(summary.lost_by_reason,
            (std::map<std::string, std::int64_t>{{"no_pair", 1}, {"unreadable", 2}}));
}

/// The slots for pairs: two a worker and two more (ordered_pairs.h), however long the recording is
/// and however slow the sink, which gets a pair two behind the one in hand.
TEST_F(MeasureRecordingTest, HoldsAFixedNumberOfPairs) {
  GiveNoise();
  options_.threads = 3;
  constexpr std::int64_t kSlots = 2 * 3 + 2;
  std::mutex mutex;
  std::set<const FramePair*> objects;
  std::int64_t most_ahead = 0;
  std::atomic<std::int64_t> handed_out{0};
  on_pair_ = [&](const PairMeasurement& measurement) {
    handed_out = measurement.frame;
    if (measurement.frame % 50 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return true;
  };
  const WatchedSource source(500, [&](std::int64_t position, const FramePair& pair) {
    const std::lock_guard<std::mutex> lock(mutex);
    objects.insert(&pair);
    most_ahead = std::max(most_ahead, position - handed_out);
  });
  EXPECT_EQ(Measure(source).pairs_read, 500);
  EXPECT_LE(static_cast<std::int64_t>(objects.size()), kSlots);
  EXPECT_LE(most_ahead, kSlots + 2);
}

TEST_F(MeasureRecordingTest, SwappedCameras) {
  std::swap(setup_.left_camera, setup_.right_camera);
  const RunSummary summary = Measure(RenderedPairs());
  EXPECT_EQ(summary.poses, 0);
  EXPECT_TRUE(AnyContains(summary.warnings, "swapped"));
}

TEST_F(MeasureRecordingTest, BodyInMetres) {
  for (Rod& rod : setup_.bodies[0].rods) {
    rod.ball_diameter_mm *= 0.001;
    for (Eigen::Vector3d& ball : rod.balls_in_body_mm) ball *= 0.001;
  }
  const RunSummary summary = Measure(RenderedPairs());
  EXPECT_EQ(summary.poses, 0);
  EXPECT_TRUE(AnyContains(summary.warnings, "wrong unit"));
}

TEST_F(MeasureRecordingTest, AnotherBody) {
  setup_.bodies[0].rods[0].balls_in_body_mm = {{0, 0, 0}, {31, 0, 0}, {90, 0, 0}, {140, 0, 0}};
  setup_.bodies[0].rods[1].balls_in_body_mm = {{0, 60, 0}, {0, 100, 0}, {0, 170, 0}};
  const RunSummary summary = Measure(RenderedPairs());
  EXPECT_EQ(summary.poses, 0);
  EXPECT_TRUE(AnyContains(summary.warnings, "body file"));
}

TEST_F(MeasureRecordingTest, DarkImages) {
  std::vector<FramePair> pairs = RenderedPairs();
  for (FramePair& pair : pairs) {
    for (int v = 0; v < 256; ++v) std::fill_n(pair.right.image.Row<std::uint8_t>(v), 320, 3);
  }
  const RunSummary summary = Measure(pairs);
  EXPECT_EQ(summary.poses, 0);
  EXPECT_TRUE(AnyContains(summary.warnings, "no balls were detected in the right images"));
  EXPECT_EQ(summary.noise_left.origin, "learned");
  EXPECT_EQ(summary.noise_right.origin, "default");
  EXPECT_TRUE(AnyContains(summary.warnings, "its noise could not be learned"));
}

TEST_F(MeasureRecordingTest, NoiseComesFromTheRigOrIsLearned) {
  setup_.rig.cameras[0].noise = noise_;
  setup_.rig.cameras[0].noise->read_e = 8.5;
  const RunSummary summary = Measure(RenderedPairs());
  EXPECT_EQ(summary.noise_left.origin, "rig");
  EXPECT_EQ(summary.noise_left.noise.read_e, 8.5);
  EXPECT_EQ(summary.noise_left.pairs_used, 0);
  EXPECT_EQ(summary.noise_right.origin, "learned");
  EXPECT_EQ(summary.noise_right.pairs_used, kPairs);
  EXPECT_TRUE(summary.warnings.empty()) << summary.warnings.front();
}

/// One uncertain parameter: the uncertainty is how far the pose goes when it moves by its σ.
TEST_F(MeasureRecordingTest, RigCovarianceBecomesCalibrationUncertainty) {
  constexpr double kSigmaMm = 1e-3;
  GiveNoise();
  setup_.rig.covariance.emplace();
  setup_.rig.covariance->parameters = {{0, 12}};  // the left camera's x
  setup_.rig.covariance->matrix = Eigen::MatrixXd::Constant(1, 1, kSigmaMm * kSigmaMm);
  Measure(RenderedPairs());
  const std::vector<PairMeasurement> stated = measurements_;
  setup_.rig.cameras[0].cam_from_world.translation_mm.x() += kSigmaMm;
  Measure(RenderedPairs());
  for (std::size_t i = 0; i < stated.size(); ++i) {
    ASSERT_TRUE(stated[i].pose && stated[i].pose->calibration_u && measurements_[i].pose);
    const Vector6d moved =
        PerturbationBetween(stated[i].pose->world_from_body, measurements_[i].pose->world_from_body)
            .cwiseAbs();
    const Vector6d& u = *stated[i].pose->calibration_u;
    EXPECT_LT((moved.head<3>() - u.head<3>()).norm(), 0.01 * u.head<3>().norm()) << i;
    EXPECT_LT((moved.tail<3>() - u.tail<3>()).norm(), 0.01 * u.tail<3>().norm()) << i;
    for (std::size_t b = 0; b < stated[i].balls.size(); ++b) {
      const BallMeasurement& ball = stated[i].balls[b];
      ASSERT_EQ(ball.status, BallStatus::kOk);
      const Eigen::Vector3d moved_mm =
          (*measurements_[i].balls[b].p_in_world_mm - *ball.p_in_world_mm).cwiseAbs();
      EXPECT_LT((moved_mm - *ball.calibration_u_mm).norm(), 0.01 * moved_mm.norm()) << i;
    }
  }
}

TEST_F(MeasureRecordingTest, CallersMistakes) {
  const StoredPairs source(RenderedPairs());
  options_.first = kPairs + 1;
  EXPECT_THROW(Measure(source), std::invalid_argument);
  options_.first = 0;
  setup_.right_camera = 0;
  EXPECT_THROW(Measure(source), std::invalid_argument);
  setup_.right_camera = 2;
  EXPECT_THROW(Measure(source), std::invalid_argument);
  setup_.right_camera = 1;
  setup_.bodies[0].rods.clear();
  EXPECT_THROW(Measure(source), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion::testing
