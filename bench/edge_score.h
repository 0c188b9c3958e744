#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "bench/edge_operators.h"
#include "bench/edge_scene.h"

namespace stereomotion::bench {

/// Sums how well maxima tell where many edges are.
struct LocalisationScore {
  double square_px2 = 0;
  int found = 0, missed = 0, stretches = 0, wrong = 0;

  [[nodiscard]] double RmsPx() const { return std::sqrt(square_px2 / found); }
  [[nodiscard]] double MissedPercent() const { return 100.0 * missed / stretches; }
  [[nodiscard]] double FalsePerPx() const { return static_cast<double>(wrong) / stretches; }
  /// Spells the three as a table's cell.
  [[nodiscard]] std::string Cell() const;
};

/// Sums what an operator makes of many edges.
struct Score {
  double edge_sum = 0, away_sum = 0, away_square = 0;
  int edge_count = 0, away_count = 0;
  LocalisationScore common;   ///< by the finder that all operators share
  LocalisationScore refined;  ///< with the operator's own step, where it has one

  [[nodiscard]] double MeanAtEdge() const { return edge_sum / edge_count; }
  [[nodiscard]] double SnrDb() const {
    return 20 * std::log10(MeanAtEdge() / std::sqrt(away_square / away_count));
  }
  [[nodiscard]] double DetectionSnrDb() const {
    const double away = away_sum / away_count;
    return 20 *
           std::log10((MeanAtEdge() - away) / std::sqrt(away_square / away_count - away * away));
  }
};

/// Judges the response: at the entries within half a pixel of the true edge, and away from it.
void ScoreResponse(const EdgeResponse& response, const Edge& edge, Score& score);

/// Judges maxima by stretches of 1 px of the edge; of several in one the clearest is the edge.
void ScoreMaxima(const std::vector<EdgeMaximum>& maxima, const Edge& edge,
                 LocalisationScore& score);

}  // namespace stereomotion::bench
