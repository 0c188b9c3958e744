#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "ball_equations.h"
#include "ball_pixel.h"
#include "edge_table.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Points at what the loops read and write.
struct BallColumns {
  int size;            ///< whole vectors
  std::ptrdiff_t gap;  ///< between two columns
  const float* __restrict u;
  const float* __restrict v;
  const float* __restrict grey;
  float* __restrict model;
  float* __restrict depth;
  float* __restrict out;
};

/// Holds the background plane and the variance along the grey values.
struct PlaneAndNoise {
  PlaneAndNoise(const FitParameters::Vector& ball, const SensorNoise& noise)
      : level(static_cast<float>(ball[BallModel::kLevel])),
        slope_u(static_cast<float>(ball[BallModel::kSlopeU])),
        slope_v(static_cast<float>(ball[BallModel::kSlopeV])),
        black(static_cast<float>(noise.black_dn)),
        saturation(static_cast<float>(noise.saturation_dn)),
        per_gain(static_cast<float>(1 / noise.gain_e_per_dn)),
        floor_dn2(static_cast<float>(noise.VarianceDn2(noise.black_dn))) {}
  float level, slope_u, slope_v;
  float black, saturation, per_gain, floor_dn2;
};

/// Sums over the pixels of a patch.
struct PixelSums {
  float chi2 = 0, deviance = 0;
  int bounds = 0;  ///< pixels at zero or saturation
};

/// Fills the columns of a ball without smear in even light: derivatives and residuals over σ.
void EvaluateBasic(const BallOutline& ball, float center_u, float center_v,
                   const PlaneAndNoise& plane, const EdgeTable& table, const BallColumns& c);

/// Adds one instant of the exposure: the ball's light and its derivatives, unweighted.
void AddInstant(const BallOutline& ball, float center_u, float center_v, float share, float time,
                const EdgeTable& table, const BallColumns& c);

/// Applies the uneven light and the background, and divides by σ.
void FinishExposure(const Eigen::Vector4f& center_and_light, const PlaneAndNoise& plane,
                    const BallColumns& c);

/// Multiplies the columns with each other (`GramMatrix`).
void MultiplyColumns(const BallColumns& c, int num_columns, float* gram);

/// Sums χ² and deviance of all pixels, and counts those that are only bounds.
PixelSums SumResiduals(const PlaneAndNoise& plane, int size, const float* grey, const float* model);

}  // namespace stereomotion
