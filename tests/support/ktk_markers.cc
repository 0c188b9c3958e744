#include "tests/support/ktk_markers.h"

#include <algorithm>
#include <stdexcept>

#include "tests/support/recording_run.h"

namespace stereomotion::testing {

C3dPoints ReadKtk(const std::string& file_name) {
  return ReadC3d(SharedData() / "real/clusters_ktk" / file_name);
}

MarkerSeries PickMarkers(const C3dPoints& points, const std::vector<std::string>& labels) {
  MarkerSeries picked;
  picked.rate_hz = points.rate_hz;
  picked.first_frame = points.first_frame;
  picked.points_mm.resize(points.points_mm.size());
  for (const std::string& label : labels) {
    const auto at = std::find(points.labels.begin(), points.labels.end(), label);
    if (at == points.labels.end()) throw std::runtime_error("no marker " + label);
    const auto place = static_cast<std::size_t>(at - points.labels.begin());
    for (std::size_t t = 0; t < points.points_mm.size(); ++t) {
      picked.points_mm[t].push_back(points.points_mm[t][place]);
    }
  }
  return picked;
}

}  // namespace stereomotion::testing
