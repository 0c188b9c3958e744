#include "learn_body_run.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>

#include "progress.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/body_folder.h"
#include "stereomotion/pipeline/learn_body.h"
#include "stop_signal.h"
#include "track_checks.h"

namespace stereomotion::app {
namespace {

constexpr const char* kOrGiveBody = "; or measure the body's rods and give --body";

std::string ReasonText(LearnBodyFailure failure, std::int64_t pairs) {
  switch (failure) {
    case LearnBodyFailure::kTooFewPairs:
      return fmt::format("too few pairs: {}; at least {} are needed", pairs, kFewestPairsToLearn);
    case LearnBodyFailure::kTooFewBalls:
      return "fewer than four balls could be followed in 3D. Check light, focus and exposure, that "
             "--left and --right are not exchanged, and that the rig belongs to these cameras";
    case LearnBodyFailure::kNoMotion:
      return "nothing moves, so bodies and background cannot be told apart. Record the body while "
             "it moves and turns";
    case LearnBodyFailure::kNoGroup:
      return "no balls keep their distances to each other. Check that the rig belongs to these "
             "cameras and that they are synchronous";
    case LearnBodyFailure::kInterrupted:
      return "interrupted";
  }
  return "";
}

std::string Describe(const Body& body) {
  std::size_t balls = 0;
  for (const Rod& rod : body.rods) balls += rod.balls_in_body_mm.size();
  return fmt::format("body '{}': {} balls on {} rods, each placed to ± {:.2g} mm or better",
                     body.name, balls, body.rods.size(), LargestBallSigmaMm(body));
}

int Refuse(const std::string& reason) {
  fmt::print(stderr, "stereomotion: no body was learned from the recording: {}\n", reason);
  return kNoAnswer;
}

}  // namespace

std::optional<int> LearnBodiesOf(const TrackOptions& options, TrackInputs& inputs,
                                 const CommonOptions& common) {
  LearnBodyOptions learn;
  learn.measure = inputs.options;
  learn.ball_diameter_mm = options.ball_diameter_mm;
  const std::int64_t rest = inputs.recording->size() - inputs.options.first;
  const std::int64_t pairs = std::min(
      learn.max_pairs, inputs.options.count < 0 ? rest : std::min(rest, inputs.options.count));
  spdlog::info("no --body: learning the bodies from {} pairs", pairs);
  const std::atomic<bool>& stop = CatchStopSignals();
  constexpr std::int64_t kRounds = 2;  // every pair is looked at twice
  Progress progress(kRounds * pairs, common.quiet);
  auto learned =
      LearnBodies(*inputs.recording, inputs.setup, learn, &stop, [&] { progress.Step(); });
  progress.Clear();
  if (!learned) {
    const bool interrupted = learned.error() == LearnBodyFailure::kInterrupted;
    return Refuse(ReasonText(learned.error(), pairs) + (interrupted ? "" : kOrGiveBody));
  }
  for (const std::string& warning : learned->warnings) spdlog::warn(warning);
  inputs.warnings.insert(inputs.warnings.end(), learned->warnings.begin(), learned->warnings.end());
  inputs.setup.bodies = std::move(learned->bodies);
  for (const Body& body : inputs.setup.bodies) {
    if (!common.quiet) spdlog::info(Describe(body));
  }
  try {
    const auto alike = CheckBodiesDiffer(inputs.setup.bodies);
    inputs.warnings.insert(inputs.warnings.end(), alike.begin(), alike.end());
  } catch (const UserError& error) {
    return Refuse(error.what());
  }
  return std::nullopt;
}

}  // namespace stereomotion::app
