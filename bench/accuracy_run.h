#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/accuracy_condition.h"
#include "bench/accuracy_score.h"

namespace stereomotion::bench {

/// Holds how one method did in one condition, or at one subpixel phase of it.
struct MethodResult {
  std::string method;
  Eigen::Vector2d phase = Eigen::Vector2d::Zero();  ///< 0: a pixel's centre … 1; each_phase only
  CenterScore score;
  std::vector<double> errors_px;  ///< distances from the truth; keeps_errors only
};

struct ConditionResult {
  Condition condition;
  double bound_px = 0;  ///< Cramér–Rao, root mean square per axis, mean over places and directions
  std::vector<MethodResult> methods;
};

/// Renders the condition's balls, lets all methods find them, compares with the truth. Depends on
/// nothing but its arguments.
ConditionResult RunCondition(const Condition& condition, std::uint64_t seed);

}  // namespace stereomotion::bench
