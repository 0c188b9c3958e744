#include "motion/law_evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/significance.h"

namespace stereomotion {
namespace {

/// Standard normal quantile of the level 1e-3.
constexpr double kLevel_z = 3.09;
/// |ΔBIC| beyond which evidence is strong (Kass & Raftery 1995, sec. 3.2).
constexpr double kStrong = 6;

/// Spells an F-distributed ratio as a standard normal number (Paulson 1942).
double NormalOfF(double ratio, double dof1, double dof2) {
  const double a = 2 / (9 * dof1), b = 2 / (9 * dof2);
  const double root = std::cbrt(ratio);
  return ((1 - b) * root - (1 - a)) / std::sqrt(b * root * root + a);
}

double ScaleOf(const LawFit& free) {
  return free.dof > 0 ? std::max(1.0, free.chi2 / free.dof) : 1;
}

bool IsFitted(const LawFit& fit) { return fit.dof >= 0 && fit.chi2 >= 0; }

bool Adequate(const LawFit& fit, const LawFit& free) {
  if (!IsFitted(fit)) return false;
  const int added = fit.dof - free.dof;
  if (added <= 0) return true;
  if (free.dof <= 0) return IsAdequate(fit.chi2, fit.dof);
  // Less noise than stated refutes nothing that the stated noise allows.
  const double ratio = (fit.chi2 - free.chi2) / added / ScaleOf(free);
  return ratio <= 1 || NormalOfF(ratio, added, free.dof) < kLevel_z;
}

/// BIC(wide) − BIC(narrow): above zero the narrow law is preferred.
double Preference(const LawFit& narrow, const LawFit& wide, double scale) {
  const double gain = narrow.chi2 - wide.chi2;
  return wide.bic - narrow.bic + gain - gain / scale;
}

}  // namespace

void MarkAdequate(std::vector<LawFit>& fits) {
  for (LawFit& fit : fits) fit.adequate = fit.law == PathLaw::kFree || Adequate(fit, fits.back());
}

LawChoice ChooseLaw(const std::vector<LawFit>& fits) {
  const LawFit& free = fits.back();
  const double scale = ScaleOf(free);
  std::size_t chosen = fits.size();
  for (std::size_t i = fits.size(); i-- > 0;) {
    if (!fits[i].adequate) continue;
    bool strong = true;
    for (std::size_t wide = i + 1; wide < fits.size(); ++wide) {
      if (fits[wide].adequate) strong &= Preference(fits[i], fits[wide], scale) > kStrong;
    }
    if (strong) chosen = i;
  }
  LawChoice choice;
  choice.law = fits[chosen].law;
  for (std::size_t i = 0; i < chosen; ++i) {
    if (!fits[i].adequate) continue;
    choice.evidence_open |= std::abs(Preference(fits[i], fits[chosen], scale)) <= kStrong;
  }
  return choice;
}

bool BendsOtherwise(const std::vector<LawFit>& fits, const LawFit& cubic) {
  if (!IsFitted(cubic)) return false;
  const double scale = ScaleOf(fits.back());
  return std::none_of(fits.begin(), fits.end() - 1, [&](const LawFit& fit) {
    return IsFitted(fit) && Preference(fit, cubic, scale) >= -kStrong;
  });
}

void WeighLaws(std::vector<LawFit>& fits) {
  const double scale = ScaleOf(fits.back());
  const auto counts = [](const LawFit& fit) { return fit.adequate && fit.law != PathLaw::kFree; };
  // The parameters of two laws differ by what their degrees of freedom do.
  const auto aic = [scale](const LawFit& fit) { return fit.chi2 / scale - 2 * fit.dof; };
  double least = std::numeric_limits<double>::infinity(), sum = 0;
  for (const LawFit& fit : fits) {
    if (counts(fit)) least = std::min(least, aic(fit));
  }
  for (LawFit& fit : fits) {
    fit.weight = counts(fit) ? std::exp(0.5 * (least - aic(fit))) : 0;
    sum += fit.weight;
  }
  for (LawFit& fit : fits) fit.weight /= std::max(sum, 1.0);
}

}  // namespace stereomotion
