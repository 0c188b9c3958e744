#include "circle_size.h"

#include <cmath>
#include <map>
#include <tuple>

#include "predict_image.h"
#include "stereomotion/core/median.h"

namespace stereomotion {

double EstimateCircleRadius(const FittedBundle& fit,
                            const std::vector<TargetObservation>& observations) {
  const BundleSolution& solution = fit.solution;
  std::map<std::tuple<int, int, int>, bool> used;
  for (const auto& o : fit.problem.observations) used[{o.camera, o.view, o.point}] = o.used;
  std::vector<double> radii_mm;
  for (const auto& o : observations) {
    if (o.diameter_px <= 0 || !used[{o.camera, o.view, o.point}]) continue;
    const Rigid3& pose = solution.views[o.view].world_from_target;
    const auto image = PredictImage(solution.cameras[o.camera], pose, solution.points[o.point]);
    if (!image) continue;
    // An ellipse's diameter is the sum of its semi-axes, which for circles seen from aside is
    // within 2 % the diameter of the circle of the same area; the shift needs no more.
    const double area_px2_mm2 =
        std::abs((image->d_world * pose.rotation.toRotationMatrix().leftCols<2>()).determinant());
    radii_mm.push_back(o.diameter_px / 2 / std::sqrt(area_px2_mm2));
  }
  return Median(std::move(radii_mm));
}

}  // namespace stereomotion
