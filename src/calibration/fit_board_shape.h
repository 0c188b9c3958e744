#pragma once

#include "fit_bundle.h"

namespace stereomotion {

/// Adjusts a bundle of a board once more with the board's points free within a printer's and a
/// board's tolerance: paper stretches and boards bend. Returns that fit where the residuals ask for
/// it (BIC), else `exact`, which took the points as they should be. (Strobl & Hirzinger 2011
/// release the board's points likewise.)
FittedBundle FitBoardShape(const FittedBundle& exact, const FitOptions& options);

}  // namespace stereomotion
