#include "refine_corner.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace stereomotion {
namespace {

/// Beyond this many blur widths from an edge grey values tell of the levels only.
constexpr double kBandBlurs = 4;
/// The blur of what is printed next reaches so many widths into the band.
constexpr double kClearBlurs = 2.7;
/// A band narrower than this has too few pixels across the edge.
constexpr double kMinBandPx = 1.2;
/// A square pixel alone has √(1/12) = 0.29 px.
constexpr double kMinBlurPx = 0.27;
/// |cos| of the angle between the normals where edges are too slanted for a corner.
constexpr double kMaxRho = 0.8;

/// Tells whether a pixel lies in the band along one of the edges.
class Band {
 public:
  Band(const CornerGuess& guess, const CornerWindow& window)
      : corner_px_(guess.pixel_px), two_sided_(guess.shape == CornerShape::kSaddle) {
    for (int i = 0; i < 2; ++i) {
      arm_[i] = guess.arms_px[i].normalized();
      normal_[i] = {-arm_[i].y(), arm_[i].x()};
      along_px_[i] = std::min(guess.along_px[i], window.max_along_px);
      const double free_px = guess.across_px[i] - kClearBlurs * window.blur_px;
      across_px_[i] = std::max(kMinBandPx, std::min(free_px, kBandBlurs * window.blur_px));
    }
  }
  [[nodiscard]] bool Has(const Eigen::Vector2d& pixel_px) const {
    const Eigen::Vector2d from_corner_px = pixel_px - corner_px_;
    for (int i = 0; i < 2; ++i) {
      const double along_px = arm_[i].dot(from_corner_px);
      const double start_px = two_sided_ ? -along_px_[i] : -across_px_[1 - i];
      if (std::fabs(normal_[i].dot(from_corner_px)) <= across_px_[i] && along_px >= start_px &&
          along_px <= along_px_[i]) {
        return true;
      }
    }
    return false;
  }
  [[nodiscard]] int ReachPx() const {
    const auto corner = [&](int i) { return std::hypot(along_px_[i], across_px_[i]); };
    return static_cast<int>(
        std::ceil(std::max({corner(0), corner(1), across_px_[0] * 1.5, across_px_[1] * 1.5})));
  }

 private:
  Eigen::Vector2d corner_px_;
  bool two_sided_;
  Eigen::Vector2d arm_[2], normal_[2];
  double along_px_[2] = {0, 0}, across_px_[2] = {0, 0};
};

CornerModel StartModel(const CornerGuess& guess, const std::vector<GreyPixel>& pixels,
                       double blur_px) {
  std::vector<double> greys;
  for (const GreyPixel& pixel : pixels) greys.push_back(pixel.grey_dn);
  std::sort(greys.begin(), greys.end());
  CornerModel model;
  model.shape = guess.shape;
  model.curvature = guess.curvature;
  model.origin_px = guess.pixel_px;
  const auto angle = [&](int i) { return std::atan2(guess.arms_px[i].y(), guess.arms_px[i].x()); };
  // Black and white are each at least a quarter of the window: their middles.
  model.values << guess.pixel_px, angle(0), angle(1), blur_px, greys[greys.size() / 8],
      greys[greys.size() * 7 / 8], 0, 0;
  return model;
}

/// Tells whether a model is a corner, near the guess.
bool InDomain(const CornerModel& model, const CornerGuess& guess) {
  const auto& values = model.values;
  const double max_blur_px = std::max(guess.along_px[0], guess.along_px[1]) / 2;
  // The guess is from whole edges: on small tags a pixel, on large ones a share of a bit.
  const double reach_px = std::max(2.0, std::min(guess.across_px[0], guess.across_px[1]));
  return values.allFinite() && values[CornerModel::kBlur] > kMinBlurPx &&
         values[CornerModel::kBlur] < max_blur_px &&
         values[CornerModel::kWhite] > values[CornerModel::kBlack] &&
         (model.corner_px() - guess.pixel_px).norm() < reach_px &&
         std::fabs(CornerPredictor(model).rho()) < kMaxRho;
}

}  // namespace

std::optional<RefinedCorner> RefineCorner(const ImageView& image, const CornerGuess& guess,
                                          const CornerWindow& window) {
  const Band band(guess, window);
  std::vector<GreyPixel> pixels =
      CutPixels(image, guess.pixel_px, band.ReachPx() + 1,
                [&](const Eigen::Vector2d& pixel_px) { return band.Has(pixel_px); });
  if (pixels.empty()) return {};
  RefinedCorner corner;
  corner.model = StartModel(guess, pixels, window.blur_px);
  GreyFit<CornerModel, CornerPredictor> fit(std::move(pixels), TopGrey(image), window.variance);
  const auto in_domain = [&](const CornerModel& model) { return InDomain(model, guess); };
  if (!fit.Minimize(corner.model, in_domain)) return {};
  const auto covariance = fit.Covariance();
  if (!covariance) return {};
  corner.covariance_px2 = covariance->topLeftCorner<2, 2>();
  corner.chi2_dof = fit.chi2_dof();
  corner.noise = fit.MeasureLevels(corner.model);
  return corner;
}

}  // namespace stereomotion
