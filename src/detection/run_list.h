#pragma once

#include <vector>

namespace stereomotion {

/// Holds neighbouring pixels of one row above a threshold.
struct Run {
  int v = 0;
  int u_begin = 0;
  int u_end = 0;  ///< one past the last
  int label = -1;
};

/// Holds runs in the order (v, u) with an index of rows and their connected components.
struct RunList {
  std::vector<Run> runs;
  std::vector<int> row_begin;  ///< height + 1 entries, after `Connect`
  std::vector<int> parent;     ///< union-find, reused
  int num_labels = 0;

  void Start(int height_px);
  /// Appends a run; joins it to the last one where they touch in the same row.
  void Append(int v, int u_begin, int u_end, int label = -1) {
    if (!runs.empty() && runs.back().v == v && runs.back().u_end == u_begin) {
      runs.back().u_end = u_end;
    } else {
      runs.push_back({v, u_begin, u_end, label});
    }
  }
  /// Labels 8-connected components by union-find, 0 … num_labels − 1 in order of first pixel.
  void Connect();
  /// Fills `row_begin`.
  void IndexRows();
};

}  // namespace stereomotion
