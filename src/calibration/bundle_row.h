#pragma once

#include <Eigen/Core>
#include <array>

#include "bundle_unknowns.h"
#include "predict_image.h"

namespace stereomotion {

/// Holds the derivatives of one observation: columns of up to 15 unknowns of its camera and three
/// of its point, and those of one local block.
struct ObservationRow {
  static constexpr int kMaxGlobal = RigParameter::kPerCamera + 3;
  Eigen::Matrix<double, 2, kMaxGlobal> global;
  std::array<int, kMaxGlobal> unknown;
  int num_global = 0;
  int block = -1;
  Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, 6> local;

  void AddGlobal(int index, const Eigen::Vector2d& column) {
    // Tied intrinsics share an unknown: their derivatives add up.
    for (int i = 0; i < num_global; ++i) {
      if (unknown[i] != index) continue;
      global.col(i) += column;
      return;
    }
    unknown[num_global] = index;
    global.col(num_global++) = column;
  }
};

/// Collects the derivatives of an observation whose point was predicted as `image`.
ObservationRow MakeRow(const BundleProblem& problem, const BundleUnknowns& unknowns,
                       const BundleObservation& observation, const PointImage& image);

}  // namespace stereomotion
