#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "stereomotion/core/pair_source.h"
#include "stereomotion/simulation/render_scene.h"
#include "stereomotion/simulation/scenario.h"

namespace stereomotion::testing {

/// Renders frame `frame` of a scenario's two cameras.
inline void RenderPair(const Scenario& scenario, std::int64_t frame, FramePair& pair) {
  for (const int camera : {0, 1}) {
    Frame& one = camera == 0 ? pair.left : pair.right;
    one.index = frame;
    one.timestamp_ns = TimeOfFrame(scenario, camera, frame).timestamp_ns;
    one.problem.clear();
    RenderSceneImage(scenario, camera, frame, one.image);
  }
}

/// Delivers pairs that are rendered when they are read: a recording of any length.
class SimulatedPairs : public PairSource {
 public:
  /// Makes the scenario of one frame; called from several threads.
  using ScenarioAt = std::function<Scenario(std::int64_t frame)>;
  SimulatedPairs(std::int64_t size, ScenarioAt scenario_at)
      : size_(size), scenario_at_(std::move(scenario_at)) {}
  [[nodiscard]] std::int64_t size() const override { return size_; }
  bool Read(std::int64_t position, FramePair& pair) const override {
    RenderPair(scenario_at_(position), position, pair);
    return true;
  }

 private:
  std::int64_t size_;
  ScenarioAt scenario_at_;
};

/// Delivers copies of pairs that are held in memory.
class StoredPairs : public PairSource {
 public:
  explicit StoredPairs(std::vector<FramePair> pairs) : pairs_(std::move(pairs)) {}
  [[nodiscard]] std::int64_t size() const override {
    return static_cast<std::int64_t>(pairs_.size());
  }
  bool Read(std::int64_t position, FramePair& pair) const override {
    pair = pairs_[static_cast<std::size_t>(position)];
    return true;
  }

 private:
  std::vector<FramePair> pairs_;
};

}  // namespace stereomotion::testing
