#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "stereomotion/core/image.h"
#include "stereomotion/core/median.h"

namespace stereomotion {

/// Predicts the variance of a pixel, a line over the grey value [DN²].
struct VarianceLine {
  double offset_dn2 = 1, slope_dn = 0;

  /// Never below 1/12: rounding to whole grey values.
  [[nodiscard]] double At(double grey_dn) const {
    return std::max(offset_dn2 + slope_dn * grey_dn, 1.0 / 12);
  }
};

/// Tells the levels of black and white in one fit, and the variances of its residuals there.
struct LevelNoise {
  double black_dn = 0, white_dn = 0;
  double black_dn2 = 0, white_dn2 = 0;  ///< 0: too few pixels
};

/// Draws the line through the usual variance of black and that of white (medians).
VarianceLine MeasureVariance(const std::vector<LevelNoise>& levels);

/// Factor on the covariance of a fit whose χ² per degree of freedom is more than chance: where the
/// print or the light is not as the model has it, a point counts for less.
double MisfitInflation(double chi2_dof);

struct GreyPixel {
  Eigen::Vector2d place_px;
  double grey_dn = 0;
};

/// Greatest grey value of the image's storage; at it a pixel is censored.
inline double TopGrey(const ImageView& image) {
  return image.type == PixelType::kGray8 ? 255 : 65535;
}

/// Gathers the pixels within `reach_px` of `center_px` (a square) that `inside` takes; none where
/// the image's border cuts them.
std::vector<GreyPixel> CutPixels(const ImageView& image, const Eigen::Vector2d& center_px,
                                 int reach_px,
                                 const std::function<bool(const Eigen::Vector2d&)>& inside);

/// Fits a model of black on white to grey values by maximum likelihood: Gauss–Newton with
/// Levenberg's damping.
///
/// `Model` has `Vector values` (kBlack, kWhite, kSlopeU, kSlopeV among them), and `Predictor`
/// gives `Grey(place, gradient)`. Pixels at the top value are censored: where the model is beyond
/// it too they agree.
template <class Model, class Predictor>
class GreyFit {
 public:
  using Vector = typename Model::Vector;
  using Matrix = typename Model::Matrix;

  GreyFit(std::vector<GreyPixel> pixels, double top_dn, const VarianceLine& variance)
      : pixels_(std::move(pixels)), top_dn_(top_dn), variance_(variance) {}

  /// Minimises χ² from `model` on; false where it does not converge while `in_domain`. The weights
  /// are those of the model: kept while a search runs, which is then repeated once.
  template <class InDomain>
  bool Minimize(Model& model, const InDomain& in_domain) {
    if (pixels_.size() < 2 * Model::kNumParameters || !in_domain(model)) return false;
    return Search(model, in_domain) && Search(model, in_domain);
  }

  /// Inverse Fisher information of the parameters; nothing where it is singular.
  [[nodiscard]] std::optional<Matrix> Covariance() const {
    const Eigen::LDLT<Matrix> factors(sums_.hessian);
    if (factors.info() != Eigen::Success || !factors.isPositive()) return {};
    const Matrix covariance = factors.solve(Matrix::Identity());
    if (!covariance.allFinite() || !(covariance.diagonal().minCoeff() > 0)) return {};
    return covariance;
  }

  [[nodiscard]] double chi2_dof() const {
    return sums_.chi2 / (static_cast<double>(pixels_.size()) - Model::kNumParameters);
  }

  /// Measures the residuals where the model is flat, black and white apart.
  [[nodiscard]] LevelNoise MeasureLevels(const Model& model) const {
    LevelNoise noise{model.values[Model::kBlack], model.values[Model::kWhite], 0, 0};
    double sums[2] = {0, 0};
    int counts[2] = {0, 0};
    const Predictor predictor(model);
    for (const GreyPixel& pixel : pixels_) {
      const double grey_dn = predictor.Grey(pixel.place_px, nullptr);
      const double share = (grey_dn - noise.black_dn) / (noise.white_dn - noise.black_dn);
      if (pixel.grey_dn >= top_dn_ || (share > 0.05 && share < 0.9)) continue;  // the edge
      const int side = share > 0.5 ? 1 : 0;
      sums[side] += (pixel.grey_dn - grey_dn) * (pixel.grey_dn - grey_dn);
      ++counts[side];
    }
    // One level is fitted to black, a level and the light's slopes to white; six more make a
    // variance.
    if (counts[0] > 7) noise.black_dn2 = sums[0] / (counts[0] - 1);
    if (counts[1] > 9) noise.white_dn2 = sums[1] / (counts[1] - 3);
    return noise;
  }

 private:
  struct Sums {
    Matrix hessian = Matrix::Zero();
    Vector pull = Vector::Zero();
    double chi2 = 0;
  };

  static constexpr int kMaxIterations = 30;
  /// χ² that a further step could still win: every parameter is within 0.03 σ of the optimum.
  static constexpr double kConverged = 1e-3;
  static constexpr double kStartDamping = 1e-2;
  /// A step damped more than this is too short to tell how much a full one would win.
  static constexpr double kTrustedDamping = 3e-2;
  /// Usual relative change of the light over one pixel, or less. Keeps the slope finite where white
  /// is overexposed and tells none.
  static constexpr double kMaxSlope = 0.05;

  template <class InDomain>
  bool Search(Model& model, const InDomain& in_domain) {
    Weigh(model);
    sums_ = Accumulate(model);
    double damping = kStartDamping;
    for (int i = 0; i < kMaxIterations; ++i) {
      const Vector step = Damped(damping).ldlt().solve(sums_.pull);
      const double gain = step.dot(sums_.pull);
      if (gain < kConverged && damping < kTrustedDamping) return true;
      Model next = model;
      next.values += step;
      const bool better = in_domain(next) && Accept(next, model);
      damping = better ? damping / 10 : std::max(damping * 10, kStartDamping);
    }
    return false;
  }

  void Weigh(const Model& model) {
    const Predictor predictor(model);
    weights_.clear();
    for (const GreyPixel& pixel : pixels_) {
      weights_.push_back(1 / variance_.At(predictor.Grey(pixel.place_px, nullptr)));
    }
  }

  Matrix Damped(double damping) const {
    Matrix damped = sums_.hessian;
    damped.diagonal() *= 1 + damping;
    return damped;
  }

  bool Accept(const Model& next, Model& model) {
    const Sums sums = Accumulate(next);
    if (!(sums.chi2 <= sums_.chi2)) return false;
    model = next;
    sums_ = sums;
    return true;
  }

  Sums Accumulate(const Model& model) const {
    Sums sums;
    const Predictor predictor(model);
    Vector gradient;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      const GreyPixel& pixel = pixels_[i];
      const double weight = weights_[i];
      const double grey_dn = predictor.Grey(pixel.place_px, &gradient);
      if (pixel.grey_dn >= top_dn_ && grey_dn >= top_dn_) continue;
      const double residual_dn = pixel.grey_dn - grey_dn;
      sums.hessian.template selfadjointView<Eigen::Lower>().rankUpdate(gradient, weight);
      sums.pull += weight * residual_dn * gradient;
      sums.chi2 += weight * residual_dn * residual_dn;
    }
    AddSlopePrior(model, sums);
    sums.hessian.template triangularView<Eigen::StrictlyUpper>() = sums.hessian.transpose();
    return sums;
  }

  static void AddSlopePrior(const Model& model, Sums& sums) {
    constexpr double kWeight = 1 / (kMaxSlope * kMaxSlope);
    for (const int k : {int{Model::kSlopeU}, int{Model::kSlopeV}}) {
      sums.hessian(k, k) += kWeight;
      sums.pull[k] -= kWeight * model.values[k];
      sums.chi2 += kWeight * model.values[k] * model.values[k];
    }
  }

  std::vector<GreyPixel> pixels_;
  std::vector<double> weights_;
  double top_dn_;
  VarianceLine variance_;
  Sums sums_;
};

}  // namespace stereomotion
