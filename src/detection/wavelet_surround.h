#pragma once

#include "wavelet_ellipse.h"
#include "wavelet_patch.h"

namespace stereomotion {

/// Measures how much more light [DN] there is just outside the outline at the brightest of eight
/// sides than at the darkest. A smear leaves light beyond the ends of its path, a ball that was
/// taken for half its size beyond one side; blur leaves as much all around. What noise of
/// `noise_dn` does to it is taken off.
double UnevennessAround(const WaveletPatch& patch, const Ellipse& ellipse, double noise_dn);

}  // namespace stereomotion
