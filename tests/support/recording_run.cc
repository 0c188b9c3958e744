#include "tests/support/recording_run.h"

#include <cstdlib>

#include "stereomotion/capture/recording.h"
#include "stereomotion/io/body_file.h"
#include "stereomotion/io/rig_file.h"

namespace stereomotion::testing {

namespace fs = std::filesystem;

RecordingRun MeasureFolder(const fs::path& recording, const std::string& rig_file) {
  RecordingRun run;
  run.setup.rig = ReadRig(recording / rig_file);
  run.setup.bodies = {ReadBody(recording / "body.yaml")};
  const auto source = OpenRecording(recording / "cam0", recording / "cam1");
  const MeasurementSink sink = [&run](const PairMeasurement& measurement) {
    run.measurements.push_back(measurement);
    return true;
  };
  run.summary = MeasureRecording(*source, run.setup, {}, sink);
  run.truth = ReadTruth(recording, run.setup.bodies.front(), {"cam0", "cam1"});
  return run;
}

fs::path SharedData() {
  const char* given = std::getenv("STEREOMOTION_SHARED_DATA");
  return given != nullptr ? fs::path(given) : fs::path(STEREOMOTION_SOURCE_DIR) / "../shared/data";
}

fs::path DemoRecording() { return fs::path(STEREOMOTION_SOURCE_DIR) / "data/demo"; }

}  // namespace stereomotion::testing
