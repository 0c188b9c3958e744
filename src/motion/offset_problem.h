#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "motion/common_errors.h"
#include "motion/point_residual.h"
#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Holds the normal equations of all poses and of what they share: the offset and the common
/// errors (in units of their own uncertainty), at one linearisation. A right image rests on the
/// poses of five frames, so the poses' matrix has a band of four blocks beside the diagonal.
struct OffsetNormals {
  static constexpr int kBand = 4;
  using BlockRow = Eigen::Matrix<double, 6, 6 * (kBand + 1)>;  ///< frame k by frames k … k + 4
  std::vector<BlockRow> hessian;
  Eigen::VectorXd gradient;     ///< of the poses
  Eigen::MatrixXd cross;        ///< poses by shared unknowns; column 0: the offset
  Eigen::MatrixXd information;  ///< of the shared unknowns, the common errors' own 1 included
  Eigen::VectorXd shared_gradient;
  double chi2 = 0;  ///< of observations and common errors
  int rows = 0;     ///< scalar observations
};

/// Holds how the path is interpolated around one frame: through the poses `first` … of up to five
/// frames (Lagrange).
struct PathStencil {
  int first = 0;
  int self = 0;                 ///< which of them is the frame itself
  std::vector<double> times_s;  ///< after the frame itself
};

/// Holds what the problem estimates.
struct OffsetUnknowns {
  std::vector<Rigid3> poses;
  double offset_s = 0;
  Eigen::VectorXd common;  ///< errors in units of their own uncertainty
};

/// Poses and time offset of a recording, estimated together from all image points. The path
/// between the frames is the polynomial through the poses around (rotation vectors against the
/// frame's own rotation), so a right image is a function of five poses and the offset. Common
/// errors enter to first order, as noise of known covariance that all images share (generalised
/// least squares): of an offset only that counts which they do not explain as well.
class OffsetProblem {
 public:
  explicit OffsetProblem(const MotionData& data, CommonErrors errors = {});

  /// The frames that take part: measured, without a free axis, enough balls, neighbours in time.
  [[nodiscard]] const std::vector<std::size_t>& frames() const { return frames_; }
  [[nodiscard]] double period_s() const { return period_s_; }
  [[nodiscard]] OffsetUnknowns Start(double offset_s) const;

  /// Where the body is `offset_s` after frame k (k counts `frames()`).
  [[nodiscard]] Rigid3 PoseAt(const std::vector<Rigid3>& poses, int k, double offset_s) const;

  /// Linearises; nothing where a camera cannot see a ball that it has seen.
  [[nodiscard]] std::optional<OffsetNormals> Linearize(const OffsetUnknowns& at) const;

 private:
  void ChooseFrames();
  void MakeStencils();
  const MotionData& data_;
  CommonErrors errors_;
  double period_s_ = 0;
  std::vector<std::size_t> frames_;
  std::vector<std::vector<PointObservation>> points_;  ///< image points only
  std::vector<PathStencil> stencils_;
};

/// Solves the poses' normal equations for several right-hand sides (columns); nothing where they
/// are singular.
std::optional<Eigen::MatrixXd> SolvePoses(const OffsetNormals& normals,
                                          const Eigen::MatrixXd& right);

/// Finds the covariance of pose k: inverse of the band matrix, of which the frames beyond the band
/// are left out (their influence is the product of two interpolation weights).
Matrix6d PoseCovariance(const OffsetNormals& normals, int k);

/// Holds poses and offset where the residuals are least.
struct OffsetSolution {
  OffsetUnknowns at;
  OffsetNormals normals;  ///< at the solution
};

/// Eliminates the poses: information of the shared unknowns, offset first; nothing where the poses'
/// equations are singular.
std::optional<Eigen::MatrixXd> SharedInformation(const OffsetNormals& normals);

/// Runs Gauss–Newton on the poses, the common errors and, unless `fixed`, the offset. Nothing: no
/// convergence, or an offset beyond the reach of the interpolation, one and a half periods.
std::optional<OffsetSolution> SolveOffset(const OffsetProblem& problem, double offset_s,
                                          bool fixed);

}  // namespace stereomotion
