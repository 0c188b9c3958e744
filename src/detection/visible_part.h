#pragma once

#include <Eigen/Core>
#include <vector>

#include "part_patch.h"
#include "rod_fit.h"
#include "rod_model.h"
#include "stereomotion/core/expected.h"
#include "stereomotion/core/image.h"
#include "stereomotion/core/sensor_noise.h"
#include "work_budget.h"

namespace stereomotion {

/// Says where a ball is sought and how balls look there.
struct PartQuery {
  Eigen::Vector2d place_px;
  UsualBall usual;
  double background_dn = 0;
  /// A fit of everything that is there, its centre at `place_px`; null: only the place is known.
  const BallModel* whole = nullptr;
  const std::vector<RodModel>* rods = nullptr;  ///< that may run through it
};

/// Holds the fit of what can be seen of a ball.
struct VisiblePart {
  RodFit fit;  ///< its model is relative to `origin_px`
  Eigen::Vector2d origin_px = Eigen::Vector2d::Zero();
  double visible_fraction = 0;  ///< share of the ball's area that took part in the fit, or nearly
  double arc_share = 0;         ///< share of its limb that took part in the fit
  double used_share = 0;        ///< share of the pixels around that took part in the fit
};

/// Says why a ball was not measured.
enum class PartFailure {
  kNoHiddenPart,  ///< no pixel stands out: what misfits is everywhere, as with a lens' aberration
  kNoFit          ///< nothing there that is a ball in part
};

/// Fits a ball that a rod runs through, of which other things hide a part, or that they touch.
///
/// Pixels that the model does not explain, and those around them that the blur mixes with them
/// (3 σ), are left out; the rest is fitted by maximum likelihood; both again until nothing changes,
/// the first rounds with a coarse measure of "explain" and with the usual shape held near. Without
/// a rod and with each rod that may be there: the fit that tells the centre best wins. So the
/// covariance is that of the pixels used, and a centre found this way is as true as one of a free
/// ball. Where the visible arc is too short to tell the ball's shape (σ of the centre beyond 2 % of
/// the radius), the shape of the image's other balls counts as one more observation, with its
/// spread from ball to ball: the only place where the covariance holds more than the pixels. Fits
/// that fail χ² (10^-3) are none. Keeps its memory.
class VisiblePartFitter {
 public:
  Expected<VisiblePart, PartFailure> Fit(const ImageView& image, const SensorNoise& noise,
                                         const PartQuery& query);
  /// Bounds the fits from now on: once it is spent they find nothing.
  WorkBudget& budget() { return budget_; }

 private:
  enum class Start { kRough, kNear };

  void Consider(const RodFit& start, Start precision, const SensorNoise& noise,
                const UsualBall& usual);
  void Assess(const RodFit& fit, const SensorNoise& noise);
  void ConsiderFoundRod(const RodFit& near, const SensorNoise& noise, const UsualBall& usual);
  bool Climb(Start precision, const SensorNoise& noise, const UsualBall& usual, RodFit& fit);
  [[nodiscard]] bool IsComplete() const;
  RodFit FitPixels(const SensorNoise& noise, const RodFit& start, BallPatch& patch,
                   const UsualBall* usual, int max_iterations);

  PartPatch patch_;
  RodPatch rod_patch_;
  WorkBudget budget_;
  bool found_ = false;
  VisiblePart best_, trial_;
};

}  // namespace stereomotion
