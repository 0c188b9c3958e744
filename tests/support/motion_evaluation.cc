#include "tests/support/motion_evaluation.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <utility>

#include "stereomotion/pipeline/motion_data_of.h"

namespace stereomotion::testing {
namespace {

namespace fs = std::filesystem;

/// Prints the figures of every recording that the program has measured.
class FiguresTable : public ::testing::Environment {
 public:
  void TearDown() override {
    if (Evaluations().empty()) return;
    fmt::print("\n{}", MotionScoreHeader());
    for (const auto& [name, evaluation] : Evaluations()) {
      fmt::print("{}", MotionScoreRow(name, evaluation.score));
    }
    for (const auto& [name, evaluation] : Evaluations()) {
      fmt::print("{:16} {}\n", name, evaluation.chosen.spin.verdict);
    }
  }
};
const ::testing::Environment* const kFiguresTable =
    ::testing::AddGlobalTestEnvironment(new FiguresTable);

}  // namespace

std::map<std::string, MotionEvaluation>& Evaluations() {
  static std::map<std::string, MotionEvaluation> evaluations;
  return evaluations;
}

std::string KeyOf(const MovingRecording& recording) {
  return std::string(recording.name) +
         (std::string(recording.rig) == "rig.yaml" ? "" : "_other_rig");
}

const MotionEvaluation* Evaluate(const MovingRecording& recording) {
  const auto known = Evaluations().find(KeyOf(recording));
  if (known != Evaluations().end()) return &known->second;
  const fs::path folder = std::string(recording.name) == "demo"
                              ? DemoRecording()
                              : SharedData() / "rendered" / recording.name;
  if (!fs::exists(folder)) return nullptr;
  MotionEvaluation evaluation;
  evaluation.run = MeasureFolder(folder, recording.rig);
  evaluation.data = MotionDataOf(evaluation.run.setup, evaluation.run.measurements);
  evaluation.chosen = AnalyseMotion(evaluation.data);
  AnalyseOptions options;
  options.center.law = recording.law;
  evaluation.given = AnalyseMotion(evaluation.data, options);
  evaluation.score = ScoreMotion(evaluation.given, evaluation.chosen, evaluation.data,
                                 evaluation.run.truth, recording.one_axis);
  return &Evaluations().emplace(KeyOf(recording), std::move(evaluation)).first->second;
}

}  // namespace stereomotion::testing
