#pragma once

#include <vector>

#include "motion/butterworth.h"
#include "motion/weight_row.h"

namespace stereomotion {

/// Gives the weights of the zero-phase Butterworth filter of one segment.
///
/// The filter runs on the uniform grid of `period_s` from the segment's first pose. A grid point
/// takes the measured pose of its time, else the cubic (Lagrange) through the two poses before and
/// the two after it: so are jitter and short gaps bridged. Both ends are continued
/// by point reflection, as far as the filter's memory or the segment reaches. Derivatives are
/// central differences of 12th order of the filtered grid.
class ButterworthRows {
 public:
  ButterworthRows(const std::vector<FilterSection>& sections, const FilterSegment& segment,
                  double period_s);

  /// Tells whether a segment is long enough: more grid points than scipy's shortest padding, three
  /// times the taps of one pass, and than the derivative's stencil reaches.
  [[nodiscard]] bool LongEnough() const { return padding_ > 0; }

  /// Finds the weights at a time inside the segment.
  [[nodiscard]] WeightRow At(double time_s) const;

 private:
  struct GridPoint {
    int first = 0;
    std::vector<double> weights;  ///< on the measured poses from `first`
  };
  void MakeGrid();
  void MakeProxies(const std::vector<FilterSection>& sections);
  /// Makes a row of zeros on all poses that the grid points from … to rest on.
  [[nodiscard]] WeightRow EmptyRow(int from, int to) const;
  [[nodiscard]] GridPoint Interpolate(double time_s, std::size_t& after) const;

  const FilterSegment& segment_;
  double period_s_;
  std::vector<GridPoint> grid_;
  int padding_ = 0;
  int memory_ = 0;  ///< grid points that a weight reaches
  /// Rows of a record that is just long enough for its middle not to feel its ends; longer records
  /// have these first and last rows, and the middle one in between.
  Eigen::MatrixXd proxy_[3];
};

}  // namespace stereomotion
