// Which balls look cut, and what is made of them.
#include <algorithm>
#include <array>

#include "second_look.h"

namespace stereomotion {
namespace {

using P = BallModel;

/// χ² of four degrees of freedom that noise reaches once in 1e4 balls.
constexpr double kAsymmetric = 23.5;
/// … and once in a hundred: worth a look.
constexpr double kHardlySymmetric = 13.3;
/// Noise makes such smears of one dim ball in a hundred; they stretch it by 2 %.
constexpr double kSlightSmear_radii = 0.5;
/// Fewer balls do not tell the usual stretch.
constexpr std::size_t kFewestForStretch = 4;
/// Evaluations of each pixel: some forty steps, each five times as dear as one of a rod's fit, of
/// a patch that is twice the ball.
constexpr int kCutWork = 400;

}  // namespace

/// Tells whether most other balls of the image are smeared as well.
bool SecondLook::SharesSmear(const First& first) const {
  int others = 0, smeared = 0;
  for (const First& other : firsts_) {
    if (&other == &first || !other.looks_ok) continue;
    ++others;
    smeared += other.model.smear_px.isZero() ? 0 : 1;
  }
  return smeared >= 2 && 3 * smeared >= 2 * others;
}

/// Tells whether a ball looks as if a part of it were hidden although its fit explains its pixels.
bool SecondLook::LooksCut(const First& first) const {
  if (!first.converged || !first.looks_ok) return false;
  const bool smeared = !first.model.smear_px.isZero();
  if (smeared && SharesSmear(first)) return !first.curved && first.asymmetry > kAsymmetric;
  return smeared || first.asymmetry > kHardlySymmetric || !first.stretch.IsUsual(usual_stretch_);
}

/// Sorts out what looks whole and what does not; the former show how balls look here.
void SecondLook::FindCut() {
  std::array<std::vector<double>, 2>& values = stretches_;
  for (int k : {0, 1}) values[k].clear();
  for (const First& first : firsts_) {
    if (!first.looks_ok || first.misfits || !first.model.smear_px.isZero()) continue;
    for (int k : {0, 1}) values[k].push_back(first.stretch.stretch[k]);
  }
  usual_stretch_.setZero();
  for (int k : {0, 1}) {
    const auto middle = values[k].begin() + static_cast<std::ptrdiff_t>(values[k].size() / 2);
    if (values[k].size() < kFewestForStretch) continue;
    std::nth_element(values[k].begin(), middle, values[k].end());
    usual_stretch_[k] = *middle;
  }
  for (First& first : firsts_) {
    first.cut = LooksCut(first);
    first.suspicious = (first.suspicious && !(first.curved && SharesSmear(first))) || first.cut;
    // Where many balls are cut, by rods, the median still tells how they look.
    const bool tells = !first.cut || firsts_.size() >= kFewestOnRod;
    if (first.looks_ok && tells) shapes_.Add(first.model);
  }
}

/// Weighs a ball that looks cut but misfits nowhere: whole and stretched or smeared, or cut?
void SecondLook::JudgeCut(const BlobScene& scene, First& first,
                          std::vector<BallObservation>& balls) {
  VisiblePart part;
  const double slight_px = kSlightSmear_radii * first.model.values[P::kRadius];
  const bool plain = first.model.smear_px.norm() < slight_px && first.asymmetry < kAsymmetric &&
                     first.stretch.IsUsual(usual_stretch_);
  fitter_.budget().Count(kCutWork * first.blob->area_px);
  const WholeBall whole{first.model, first.center_px, plain};
  switch (cut_look_.Judge(scene.image, scene.noise, *first.blob, whole, part)) {
    case CutVerdict::kWhole:
      first.solved = !first.misfits && first.asymmetry < kAsymmetric;
      return;
    case CutVerdict::kCut:
      rods_.clear();
      first.measured = first.solved = Accept(scene, *first.blob, part, balls[first.ball]);
      return;
    case CutVerdict::kUndecided:
      return;
  }
}

}  // namespace stereomotion
