#pragma once

#include <Eigen/Core>
#include <vector>

#include "rod_model.h"

namespace stereomotion {

/// Collects the rods found in an image: a rod runs through several balls.
class RodLines {
 public:
  void Clear() { lines_.clear(); }
  /// Takes note of a rod that runs through a ball.
  void Add(const Eigen::Vector2d& center_px, const RodModel& rod) {
    lines_.push_back({center_px, rod});
  }
  /// Lists the rods that may run through a ball near `place_px`, each once.
  void Near(const Eigen::Vector2d& place_px, double radius_px, std::vector<RodModel>& rods) const;

 private:
  struct Line {
    Eigen::Vector2d center_px;
    RodModel rod;
  };
  std::vector<Line> lines_;
};

}  // namespace stereomotion
