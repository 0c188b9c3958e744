#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "stereomotion/capture/recording.h"
#include "stereomotion/io/body_file.h"
#include "stereomotion/io/rig_file.h"
#include "stereomotion/io/run_writer.h"
#include "stereomotion/pipeline/measure.h"
#include "tests/support/recording_run.h"

namespace stereomotion::testing {
namespace {

namespace fs = std::filesystem;

using FileBytes = std::map<std::string, std::string>;

FileBytes TrackDemo(int threads) {
  const fs::path demo = DemoRecording();
  const fs::path folder =
      fs::path(::testing::TempDir()) / ("stereomotion_same_bytes_" + std::to_string(threads));
  const auto source = OpenRecording(demo / "cam0", demo / "cam1");
  const MeasureSetup setup{ReadRig(demo / "rig.yaml"),     0,  1,
                           {ReadBody(demo / "body.yaml")}, {}, {}};
  MeasureOptions options;
  options.threads = threads;
  {
    RunWriter writer(folder, {setup.bodies, "cam0", "cam1"}, /*overwrite=*/true, {});
    MeasureRecording(*source, setup, options, [&writer](const PairMeasurement& measurement) {
      writer.Write(measurement);
      return true;
    });
  }
  FileBytes files;
  for (const char* name : {"poses.csv", "balls.csv", "detections.csv"}) {
    std::ifstream stream(folder / name, std::ios::binary);
    files[name] = {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }
  fs::remove_all(folder);
  return files;
}

TEST(MeasureRecording, WritesTheSameBytesOnAnyNumberOfThreads) {
  const FileBytes one = TrackDemo(1);
  for (const auto& [name, bytes] : one) EXPECT_GT(bytes.size(), 1000U) << name;
  for (const int threads : {2, 5}) {
    for (const auto& [name, bytes] : TrackDemo(threads)) {
      EXPECT_TRUE(bytes == one.at(name)) << name << " with " << threads << " threads";
    }
  }
}

}  // namespace
}  // namespace stereomotion::testing
