#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "motion/filter_methods.h"
#include "motion/minimize_log.h"
#include "motion/rts_smoother.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

constexpr std::size_t kFewestPoses = 3;  // a rate, and one more to smooth

bool LongEnough(const FilterSegment& segment) { return segment.measured.size() >= kFewestPoses; }

/// Sums the innovations' misfit over the segments, up to as many poses as densities need.
double Misfit(const PoseSeries& series, const std::vector<FilterSegment>& segments,
              const MotionNoise& noise) {
  constexpr std::size_t kEnough = 2000;  // densities known to 3 %
  double misfit = 0;
  std::size_t used = 0;
  for (const FilterSegment& segment : segments) {
    if (!LongEnough(segment) || used >= kEnough) continue;
    const std::size_t count = std::min(segment.measured.size(), kEnough);
    misfit +=
        InnovationMisfit(series, segment.measured.front(), segment.measured[count - 1], noise);
    used += count;
  }
  return misfit;
}

/// Finds the densities that make the innovations most likely, where they are not given. Rotation
/// and translation hang together only through the poses' cross-covariances: two rounds do.
MotionNoise EstimateNoise(const PoseSeries& series, const std::vector<FilterSegment>& segments,
                          const FilterOptions& options) {
  MotionNoise noise{options.rotation_psd_rad2_s3.value_or(1),
                    options.translation_psd_mm2_s3.value_or(1e4)};
  const bool both = !options.rotation_psd_rad2_s3 && !options.translation_psd_mm2_s3;
  for (int round = 0; round < (both ? 2 : 1); ++round) {
    const auto search = [&](double& density, double low, double high) {
      const auto misfit = [&](double value) {
        density = value;
        return Misfit(series, segments, noise);
      };
      density = MinimizeOverDecades(misfit, low, high);
    };
    // From a body at rest on a table to one that is shot: 1e-8 … 1e6 rad²/s³ and as many mm²/s³.
    if (!options.rotation_psd_rad2_s3) search(noise.rotation_rad2_s3, -8, 6);
    if (!options.translation_psd_mm2_s3) search(noise.translation_mm2_s3, -4, 10);
  }
  return noise;
}

FilteredSample SampleOf(const PoseSample& sample, const PoseSample& nearest,
                        const MotionState& state, int window) {
  FilteredSample out;
  out.status = sample.measured ? MotionStatus::kOk : MotionStatus::kFilled;
  out.pose = nearest;
  out.pose.frame = sample.frame;
  out.pose.timestamp_ns = sample.timestamp_ns;
  out.pose.world_from_body = state.world_from_body;
  out.pose.world_from_body.rotation = WithPositiveW(state.world_from_body.rotation);
  Eigen::Matrix<double, 12, 12> across = Eigen::Matrix<double, 12, 12>::Identity();
  if (nearest.free_axis_in_world) {
    const Eigen::Vector3d axis =
        (state.world_from_body.rotation * nearest.world_from_body.rotation.conjugate()) *
        *nearest.free_axis_in_world;
    across.block<3, 3>(0, 0) -= axis * axis.transpose();
    across.block<3, 3>(6, 6) -= axis * axis.transpose();
    out.pose.free_axis_in_world = axis;
  }
  const Eigen::Matrix<double, 12, 12> covariance = across * state.covariance * across;
  out.pose.covariance = covariance.topLeftCorner<6, 6>();
  out.velocity.status = out.status;
  out.velocity.omega_rad_s = state.omega_rad_s;
  out.velocity.velocity_mm_s = state.velocity_mm_s;
  out.velocity.covariance.topLeftCorner<6, 6>() = covariance.bottomRightCorner<6, 6>();
  out.velocity.window = window;
  return out;
}

}  // namespace

std::string FilterByRts(const PoseSeries& series, const std::vector<FilterSegment>& segments,
                        const FilterOptions& options, std::vector<FilteredSample>& samples) {
  for (const auto& psd : {options.rotation_psd_rad2_s3, options.translation_psd_mm2_s3}) {
    if (psd && !(*psd > 0)) throw std::invalid_argument("RTS smoother: a density must be positive");
  }
  const MotionNoise noise = EstimateNoise(series, segments, options);
  for (const FilterSegment& segment : segments) {
    if (!LongEnough(segment)) continue;
    const std::size_t first = segment.measured.front(), last = segment.measured.back();
    const auto states = SmoothSegment(series, first, last, noise);
    std::size_t nearest = first;  // the last measured one
    for (std::size_t i = first; i <= last; ++i) {
      if (series[i].measured) nearest = i;
      samples[i] = SampleOf(series[i], series[nearest], states[i - first],
                            static_cast<int>(segment.measured.size()));
    }
  }
  const bool estimated = !options.rotation_psd_rad2_s3 || !options.translation_psd_mm2_s3;
  return fmt::format(
      "Rauch-Tung-Striebel smoother, white acceleration of {:.3g} rad^2/s^3 and {:.3g} mm^2/s^3{}",
      noise.rotation_rad2_s3, noise.translation_mm2_s3,
      estimated ? " (maximum likelihood of the innovations, where not given)" : "");
}

}  // namespace stereomotion
