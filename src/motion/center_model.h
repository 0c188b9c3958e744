#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "motion/observed_frame.h"

namespace stereomotion {

/// Describes the least-squares problem of a body whose spin centre moves by a law.
///
/// Global unknowns: y of the centre c = origin + basis · y; the path's coefficients in scaled time
/// τ, p(τ) = Σ p_k τᵏ; s of the balls b = start + gauge · s. Local unknowns, of every frame: the
/// left rotation step δθ from the frame's start, after which t = p − R c; without a path (a free
/// body) also a step δt of the translation.
struct CenterModel {
  const std::vector<ObservedFrame>* frames = nullptr;
  int path_terms = 1;  ///< coefficients of the path; 0: every frame has its own translation
  Eigen::Vector3d origin_in_body_mm = Eigen::Vector3d::Zero();
  Eigen::Matrix3Xd basis = Eigen::Matrix3d::Identity();  ///< orthonormal columns
  std::vector<Eigen::Vector3d> balls_in_body_mm;
  Eigen::MatrixXd gauge;  ///< 3M×(3M − 6), or no columns where the balls are known
  double mid_s = 0, half_span_s = 1;

  [[nodiscard]] Eigen::Index LocalSize() const { return path_terms == 0 ? 6 : 3; }
  [[nodiscard]] Eigen::Index CenterSize() const { return path_terms == 0 ? 0 : basis.cols(); }
  [[nodiscard]] Eigen::Index PathSize() const { return 3 * path_terms; }
  [[nodiscard]] Eigen::Index GlobalSize() const { return CenterSize() + PathSize() + gauge.cols(); }
  [[nodiscard]] double Tau(double time_s) const { return (time_s - mid_s) / half_span_s; }
};

/// Holds values of a model's unknowns.
struct CenterUnknowns {
  Eigen::VectorXd globals;
  Eigen::MatrixXd locals;  ///< a column a frame
};

/// Holds a frame's whitened residuals with their derivatives by left perturbations.
struct CenterEquations {
  Eigen::VectorXd residual;
  Eigen::MatrixXd d_local, d_global;
};

/// Makes the unknowns' start: no steps, everything at its origin.
CenterUnknowns ZeroUnknowns(const CenterModel& model);

/// Spreads the columns of scaled time: derivative 0, 1 or 2 of Σ p_k τᵏ by time; 3 × 3·path_terms.
Eigen::MatrixXd PathColumns(const CenterModel& model, double time_s, int derivative);

Eigen::Vector3d CenterInBody(const CenterModel& model, const Eigen::VectorXd& globals);
std::vector<Eigen::Vector3d> Balls(const CenterModel& model, const Eigen::VectorXd& globals);

/// Gives the pose that a frame's unknowns mean.
Rigid3 PoseOf(const CenterModel& model, const ObservedFrame& frame, const Eigen::VectorXd& local,
              const Eigen::VectorXd& globals);

/// Linearises one frame; nothing where a camera cannot see a ball.
std::optional<CenterEquations> Linearize(const CenterModel& model, const ObservedFrame& frame,
                                         const Eigen::VectorXd& local,
                                         const Eigen::VectorXd& globals);

/// Spans the changes of a structure that are neither a shift of the balls' mean nor, to first
/// order, a turn: 3M×(3M − 6), orthonormal.
Eigen::MatrixXd StructureGauge(const std::vector<Eigen::Vector3d>& balls_in_body_mm);

}  // namespace stereomotion
