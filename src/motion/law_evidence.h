#pragma once

#include <vector>

#include "stereomotion/motion/spin_center.h"

namespace stereomotion {

/// Holds the outcome of weighing the laws.
struct LawChoice {
  PathLaw law = PathLaw::kFree;
  bool evidence_open = false;
};

/// Marks which laws are not refuted: F test (Paulson 1942's approximation) of what the law adds to
/// χ² against the noise that the frames' own poses show (at least the stated one), level 1e-3;
/// where poses are all that was observed, χ² test with the slack that real σ need (significance.h).
/// The last fit is the free one.
void MarkAdequate(std::vector<LawFit>& fits);

/// Chooses among fits ordered from narrow to wide, the last one free: the narrowest adequate law
/// that BIC prefers strongly (by more than 6; Kass & Raftery 1995) to every wider one. Where
/// the difference is open the wider law is taken. χ² is divided by the noise's scale where the
/// frames' own poses show more noise than stated.
LawChoice ChooseLaw(const std::vector<LawFit>& fits);

/// Tells whether BIC strongly prefers a cubic path to every law. Free poses are too wide an
/// alternative to show it: they refute a law by thousands of parameters at once.
bool BendsOtherwise(const std::vector<LawFit>& fits, const LawFit& cubic);

/// Gives each adequate law its share, exp(−AIC/2), χ² scaled as above. Not BIC's: its penalty grows
/// with the recording, so a motion of the centre of one to three σ, which the data hardly tells but
/// which moves the narrow law's centre by many of its σ, would get no share.
void WeighLaws(std::vector<LawFit>& fits);

}  // namespace stereomotion
