#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "blob_measurer.h"
#include "cut_ball.h"
#include "cut_look.h"
#include "find_discs.h"
#include "fit_ball.h"
#include "rod_lines.h"
#include "segment_blobs.h"
#include "usual_ball.h"
#include "visible_part.h"

namespace stereomotion {

/// Measures what a fit of the ball alone does not explain: balls that a rod runs through, that are
/// hidden in part, merged or shone upon.
///
/// The first look at an image (a fit a blob) hands over what it found. Blobs whose fit is worse
/// than noise makes it are then fitted as visible parts: first around the place found, for rods;
/// then, now that rods and the usual ball of the image are known, around every place where a disc
/// may lie, merged blobs included. What is measured so has status `kOk`; what has a misfit that
/// nothing explains is flagged, never `kOk`. The work is bounded: what
/// is beyond, the least ball-like last, is flagged. Keeps its memory.
class SecondLook {
 public:
  /// Begins an image.
  void Start();
  /// Takes note of a first look (`limb_asymmetry`: of `LimbAsymmetry`); `ball` is the index of its
  /// observation.
  void Add(const Blob& blob, const BallFit& fit, const Eigen::Vector2d& origin_px,
           double limb_asymmetry, std::size_t ball, const BallObservation& observation);
  /// Looks again where that is worth it; replaces and appends observations.
  void Finish(const BlobScene& scene, std::vector<BallObservation>& balls);

 private:
  /// A rod carries so many balls, at least.
  static constexpr std::size_t kFewestOnRod = 3;

  struct First {
    const Blob* blob;
    std::size_t ball;
    BallModel model;
    Eigen::Vector2d center_px;
    bool suspicious, converged;
    bool curved;           ///< smeared, with the mild misfit of a bent path
    bool misfits;          ///< worse than noise
    bool looks_ok;         ///< to the first look
    double asymmetry;      ///< of the limb
    StretchOfFit stretch;  ///< of the fit
    double chi2_dof;       ///< of the fit
    bool cut = false;      ///< looks so, whatever its χ²
    /// By the second look; solved: nothing better is to be expected.
    bool measured = false, solved = false;
    bool looked = false;  ///< at its place; not where the work was too much
  };
  void OrderLooks(bool known);
  void LookAtEach(const BlobScene& scene, bool known, std::vector<BallObservation>& balls);
  [[nodiscard]] bool IsOtherThing(const First& first) const;
  void LookNear(const BlobScene& scene, First& first, std::vector<BallObservation>& balls);
  void FindCut();
  [[nodiscard]] bool SharesSmear(const First& first) const;
  [[nodiscard]] bool LooksCut(const First& first) const;
  void JudgeCut(const BlobScene& scene, First& first, std::vector<BallObservation>& balls);
  void LookAround(const BlobScene& scene, const Blob& blob, First* first,
                  std::vector<BallObservation>& balls);
  bool Accept(const BlobScene& scene, const Blob& blob, const VisiblePart& part,
              BallObservation& ball);
  void LookAtRejected(const BlobScene& scene, std::vector<BallObservation>& balls);
  [[nodiscard]] bool IsBallBright(const Blob& blob) const;

  std::vector<First> firsts_;
  std::vector<std::size_t> order_;  ///< of looking at them
  RodLines lines_;
  std::vector<RodModel> rods_;
  BallShapes shapes_;
  UsualBall usual_;
  bool lone_ = false;                             ///< the image shows no other ball to compare with
  std::array<std::vector<double>, 2> stretches_;  ///< work memory
  DiscFinder discs_;
  Eigen::Vector2d usual_stretch_ = Eigen::Vector2d::Zero();
  VisiblePartFitter fitter_;
  CutLook cut_look_;
};

}  // namespace stereomotion
