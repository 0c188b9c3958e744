#pragma once

namespace stereomotion {

/// Holds the nodes of a quadrature over [−1, 1].
struct QuadratureNodes {
  int count;
  const double* place;
  const double* weight;
};

/// Nodes that a smear needs for each standard deviation of the blur it crosses. In the middle of
/// the rule they lie π/2 times wider apart than on average, here 2.4 blurs: the sum of Gaussian
/// edges ripples by 2 exp(−2π² / 2.4²) = 6 % of an edge's slope, which feigns 0.2 % of information,
/// and by 1e-3 of the light's amplitude.
constexpr double kFineNodesPerBlur = 0.65;
/// Enough for the first steps of a search.
constexpr double kCoarseNodesPerBlur = 0.4;

/// Counts the nodes for a smear of `length_blurs` standard deviations of the blur; one: no smear.
int CountNodes(double length_blurs, double nodes_per_blur = kFineNodesPerBlur);

/// Gives the Gauss–Legendre rule of `count` nodes (1 … 96).
QuadratureNodes GaussLegendre(int count);

}  // namespace stereomotion
