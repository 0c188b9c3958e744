#pragma once

#include <Eigen/Core>
#include <optional>

#include "stereomotion/core/body.h"
#include "stereomotion/geometry/rigid3.h"
#include "tests/support/statistics.h"

namespace stereomotion::testing {

/// Lists the balls of a body, one a column.
Eigen::Matrix3Xd BallColumns(const Body& body);

/// Gives the true body's balls in the order and under the names of the learned one's: rods are told
/// by their spacings, to 1 mm. Nothing where a learned rod is no true one.
std::optional<Body> InOrderOf(const Body& learned, const Body& truth);

/// Finds the frame that a learned body is in: learned_from_truth, by least squares over the balls.
Rigid3 LearnedFromTruth(const Body& learned, const Body& ordered_truth);

/// Adds the error of a learned body, in its gauge, whitened by its covariance (3M − 6 numbers).
void AddInGauge(const Body& learned, const Body& ordered_truth, ErrorStatistics& statistics);

}  // namespace stereomotion::testing
