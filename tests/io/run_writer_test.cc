#include "stereomotion/io/run_writer.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <clocale>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "io_test_support.h"
#include "stereomotion/core/output_error.h"
#include "stereomotion/io/body_folder.h"
#include "stereomotion/io/csv_rows.h"
#include "stereomotion/io/suggest.h"
#include "stereomotion/pose/status_words.h"

namespace stereomotion {
namespace {

using testing::TemporaryFolder;

Body OneRod() { return {"plate", {{"A", 16, {{0, 0, 0}, {40, 0, 0}, {95, 0, 0}}, 0}}}; }

PairMeasurement WithPose() {
  PairMeasurement measurement;
  measurement.frame = 7;
  measurement.timestamp_ns = 1'000'000'000'123'456'789;
  measurement.status = PoseStatus::kOk;
  PoseEstimate pose;
  pose.world_from_body = {Eigen::Quaterniond(-1, 0, 0, 0), {-0.0, 1.0 / 3, 2500}};
  pose.covariance(0, 1) = pose.covariance(1, 0) = 1e-12;
  pose.rms_px = 0.25;
  pose.balls_left = 3;
  pose.balls_right = 2;
  measurement.pose = pose;
  BallMeasurement ball;
  ball.id = {0, 1};
  ball.status = BallStatus::kLeftOnly;
  ball.left = CenterObservation{0, {10.5, 20}, Eigen::Matrix2d::Identity()};
  measurement.balls = {ball};
  MatchedDetection detection;
  detection.observation.center_px = {10, 20};
  detection.observation.semi_major_px = 5;
  detection.observation.semi_minor_px = 4;
  measurement.left = {detection};
  return measurement;
}

std::vector<std::string> Cells(const std::string& row) {
  std::vector<std::string> cells(1);
  for (const char c : row) {
    if (c == ',') {
      cells.emplace_back();
    } else if (c != '\n') {
      cells.back() += c;
    }
  }
  return cells;
}

std::string Content(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::string PoseRow(const PairMeasurement& measurement) {
  std::string row;
  AppendPoseRow(measurement, row);
  return row;
}

TEST(CsvRows, EveryRowHasItsHeadersCells) {
  PairMeasurement lost;
  const Body body = OneRod();
  for (const PairMeasurement& m : {WithPose(), lost}) {
    std::string balls, detections;
    AppendBallRows(m, body, balls);
    AppendDetectionRows(m, body, "cam0", "cam1", detections);
    EXPECT_EQ(Cells(PoseRow(m)).size(), Cells(std::string(PosesHeader())).size());
    if (m.balls.empty()) continue;
    EXPECT_EQ(Cells(balls).size(), Cells(std::string(BallsHeader())).size());
    EXPECT_EQ(Cells(detections).size(), Cells(std::string(DetectionsHeader())).size());
  }
  EXPECT_EQ(Cells(std::string(PosesHeader())).size(), 13U + 21U + 6U + 3U);
}

TEST(CsvRows, PoseRowExactly) {
  EXPECT_EQ(PoseRow(WithPose()),
            "7,1000000000123456789,ok,3,2,0.25,1,0,0,0,0,0.3333333333,2500,"
            "0,1e-12,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,,,,,,,,,\n");
}

TEST(CsvRows, BallAndDetectionRowsExactly) {
  std::string balls, detections;
  AppendBallRows(WithPose(), OneRod(), balls);
  AppendDetectionRows(WithPose(), OneRod(), "cam0", "cam1", detections);
  EXPECT_EQ(balls, "7,A,1,left_only,,,,,,,,,,10.5,20,1,0,1,,,,,,,,\n");
  EXPECT_EQ(detections, "7,cam0,ok,,,0,0,0,10,20,9,0,1,,\n");
}

TEST(CsvRows, NotANumberIsAnEmptyCell) {
  PairMeasurement m = WithPose();
  m.pose->rms_px = std::nan("");
  EXPECT_EQ(Cells(PoseRow(m))[5], "");
}

TEST(CsvRows, WordsDoNotDependOnTheLocale) {
  if (std::setlocale(LC_ALL, "de_DE.UTF-8") == nullptr) GTEST_SKIP() << "no German locale here";
  EXPECT_EQ(Cells(PoseRow(WithPose()))[5], "0.25");
  std::setlocale(LC_ALL, "C");
}

TEST(StatusWords, AreDifferent) {
  std::set<std::string_view> words;
  for (int i = 0; i <= static_cast<int>(PoseStatus::kRollUndetermined); ++i) {
    words.insert(StatusWord(static_cast<PoseStatus>(i)));
  }
  EXPECT_EQ(words.size(), 7U);
  EXPECT_EQ(words.count(""), 0U);
}

RunRecord Record() {
  RunRecord record;
  record.version = "1.2.3";
  record.command = {"stereomotion", "track"};
  record.left_frames = 5;
  record.unpaired_left = 2;
  record.inputs = {{"rig", "rig.yaml", ""}};
  record.summary.lost_by_reason["lost"] = 3;
  record.summary.warnings = {"bad name: \xff"};
  return record;
}

TEST(RunWriter, WritesValidFilesFromTheStart) {
  TemporaryFolder folder;
  const auto run = folder.path() / "a" / "run";
  RunWriter writer(run, {{OneRod()}, "cam0", "cam1"}, false, Record());
  writer.Write(WithPose());
  const auto json = nlohmann::json::parse(Content(run / "run.json"));
  EXPECT_EQ(json["state"], "running");
  EXPECT_EQ(json["frames"]["paired"], 3);
  EXPECT_EQ(json["frames"]["lost"]["lost"], 3);
  EXPECT_TRUE(json["inputs"][0]["sha256"].is_null());
  EXPECT_EQ(Content(run / "poses.csv"), std::string(PosesHeader()) + "\n" + PoseRow(WithPose()));
  RunRecord record = Record();
  record.state = "done";
  writer.WriteRecord(record);
  EXPECT_EQ(Content(run / "run.json"), RunJson(record));
}

TEST(RunWriter, NeverOverwritesUnasked) {
  TemporaryFolder folder;
  folder.Write("run/precious.txt", "x");
  const auto open = [&](const std::string& name, bool overwrite) {
    return testing::Error([&] {
      RunWriter(folder.path() / name, {{OneRod()}, "l", "r"}, overwrite, Record());
    });
  };
  EXPECT_TRUE(testing::Has(open("run", false), "give --force"));
  EXPECT_EQ(open("run", true), "no error");
  EXPECT_EQ(Content(folder.path() / "run/precious.txt"), "x");
  EXPECT_TRUE(testing::Has(open("run/precious.txt", true), "is a file"));
}

TEST(RunWriter, PlaceThatCannotBeWritten) {
  EXPECT_THROW(RunWriter("/proc/run", {{OneRod()}, "l", "r"}, false, Record()), OutputError);
}

// A limit on the file size stands in for the full disk: the system takes part of a write, then
// none.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallDisk() { setrlimit(RLIMIT_FSIZE, &before_); }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  rlimit before_{};
};

TEST(RowFile, TakesRowsWholeOrNotAtAll) {
  TemporaryFolder folder;
  RowFile file(folder.path() / "rows.csv");
  const SmallDisk disk(10);
  file.Append("abcd\n");
  EXPECT_THROW(file.Append("0123456789\n"), OutputError);
  EXPECT_EQ(Content(folder.path() / "rows.csv"), "abcd\n");
  file.Append("efgh\n");
  EXPECT_EQ(Content(folder.path() / "rows.csv"), "abcd\nefgh\n");
}

TEST(RowFile, OverwriteThatFindsNoRoomKeepsTheOld) {
  TemporaryFolder folder;
  RowFile file(folder.path() / "run.json");
  const SmallDisk disk(10);
  file.Append("{}      \n");
  file.Overwrite("{1}\n");
  EXPECT_EQ(Content(folder.path() / "run.json"), "{1}\n");
  EXPECT_THROW(file.Overwrite("0123456789\n"), OutputError);
  EXPECT_EQ(Content(folder.path() / "run.json"), "{1}\n");
}

TEST(RunWriter, FullDiskLeavesTheSamePairsInAllFiles) {
  TemporaryFolder folder;
  RunWriter writer(folder.path() / "run", {{OneRod()}, "cam0", "cam1"}, false, Record());
  const auto pose_rows = [&] {
    const std::string text = Content(folder.path() / "run/poses.csv");
    return std::count(text.begin(), text.end(), '\n') - 1;
  };
  const SmallDisk disk(2000);  // run.json has its room already
  EXPECT_THROW(
      {
        for (int i = 0; i < 100; ++i) writer.Write(WithPose());
      },
      OutputError);
  const std::string balls = Content(folder.path() / "run/balls.csv");
  EXPECT_GT(pose_rows(), 0);
  EXPECT_EQ(std::count(balls.begin(), balls.end(), '\n') - 1, pose_rows());
  EXPECT_EQ(Content(folder.path() / "run/poses.csv").back(), '\n');
}

std::vector<Body> TwoBodies() {
  std::vector<Body> bodies{OneRod(), OneRod()};
  bodies[1].name = "shank";
  return bodies;
}

PairMeasurement OfBody(int body) {
  PairMeasurement measurement = WithPose();
  measurement.body = body;
  return measurement;
}

TEST(RunWriter, SeveralBodiesHaveFoldersOfTheirOwn) {
  TemporaryFolder folder;
  const auto run = folder.path() / "run";
  RunWriter writer(run, {TwoBodies(), "cam0", "cam1"}, false, Record());
  const std::string header = std::string(PosesHeader()) + "\n";
  writer.Write(OfBody(0));
  EXPECT_EQ(Content(run / "plate/poses.csv"), header);  // the pair is not whole yet
  writer.Write(OfBody(1));
  for (const char* name : {"plate", "shank"}) {
    EXPECT_EQ(Content(run / name / "poses.csv"), header + PoseRow(WithPose())) << name;
    EXPECT_TRUE(std::filesystem::exists(run / name / "detections.csv"));
  }
  EXPECT_FALSE(std::filesystem::exists(run / "poses.csv"));
}

TEST(RunWriter, FullDiskLeavesTheSamePairsOfAllBodies) {
  TemporaryFolder folder;
  const auto run = folder.path() / "run";
  RunWriter writer(run, {TwoBodies(), "cam0", "cam1"}, false, Record());
  // The second body's rows are longer: its file is the first that finds no room.
  PairMeasurement longer = OfBody(1);
  longer.balls.resize(3, longer.balls.front());
  const SmallDisk disk(2000);
  EXPECT_THROW(
      {
        for (int i = 0; i < 100; ++i) {
          writer.Write(OfBody(0));
          writer.Write(longer);
        }
      },
      OutputError);
  const auto rows = [&](const std::string& file) {
    const std::string text = Content(run / file);
    EXPECT_EQ(text.back(), '\n') << file;
    return std::count(text.begin(), text.end(), '\n') - 1;
  };
  EXPECT_GT(rows("plate/poses.csv"), 0);
  EXPECT_EQ(rows("plate/balls.csv"), rows("plate/poses.csv"));
  EXPECT_EQ(rows("shank/poses.csv"), rows("plate/poses.csv"));
  EXPECT_EQ(rows("shank/balls.csv"), 3 * rows("plate/poses.csv"));
}

TEST(RunWriter, OverwritingRemovesTheRunBefore) {
  TemporaryFolder folder;
  const auto run = folder.path() / "run";
  { RunWriter writer(run, {TwoBodies(), "l", "r"}, false, Record()); }
  folder.Write("run/plate/motion.json", "{}");
  folder.Write("run/joint.json", "{}");
  folder.Write("run/shank/notes.txt", "x");
  { RunWriter writer(run, {{OneRod()}, "l", "r"}, true, Record()); }
  EXPECT_FALSE(std::filesystem::exists(run / "plate"));
  EXPECT_FALSE(std::filesystem::exists(run / "joint.json"));
  EXPECT_FALSE(std::filesystem::exists(run / "shank/poses.csv"));
  EXPECT_EQ(Content(run / "shank/notes.txt"), "x");
  EXPECT_TRUE(std::filesystem::exists(run / "poses.csv"));
}

TEST(CheckRunFolder, ChangesNothing) {
  TemporaryFolder folder;
  const auto run = folder.path() / "run";
  { RunWriter writer(run, {{OneRod()}, "l", "r"}, false, Record()); }
  EXPECT_THROW(CheckRunFolder(run, false), UserError);
  CheckRunFolder(run, true);
  EXPECT_TRUE(std::filesystem::exists(run / "poses.csv"));
  CheckRunFolder(folder.path() / "new", false);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "new"));
  PrepareRunFolder(run, true);
  EXPECT_TRUE(std::filesystem::is_empty(run)) << "no run.json that says `done` without files";
}

TEST(BodyNames, FitForFolders) {
  const auto problem = [](const std::string& a, const std::string& b) {
    std::vector<Body> bodies = TwoBodies();
    bodies[0].name = a;
    bodies[1].name = b;
    return BodyNameProblem(bodies);
  };
  EXPECT_EQ(problem("thigh", "shank 2.1"), "");
  EXPECT_EQ(problem("Oberschenkel-\xc3\xa4", "b"), "");
  for (const char* bad : {"", "..", ".x", "x.", " x", "a/b", "a\\b", "a\nb", "a:b"}) {
    EXPECT_NE(problem(bad, "b"), "") << bad;
  }
  EXPECT_NE(problem(std::string(101, 'x'), "b"), "");
  EXPECT_NE(problem("thigh", "Thigh"), "");
  EXPECT_EQ(BodyNameProblem({OneRod()}), "");
  EXPECT_EQ(BodyNameProblem({Body{}}), "");  // alone, nobody asks for its name
}

TEST(Suggest, Distances) {
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3);
  EXPECT_EQ(EditDistance("ab", "ba"), 1);
  EXPECT_EQ(EditDistance("", "abc"), 3);
  EXPECT_EQ(DidYouMean("colour", {"rods", "name"}), "");
  EXPECT_EQ(DidYouMean("nmae", {"rods", "name"}), "; did you mean 'name'?");
}

}  // namespace
}  // namespace stereomotion
