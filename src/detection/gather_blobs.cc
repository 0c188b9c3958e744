#include "gather_blobs.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace stereomotion {
namespace {

void AddRun(const Run& run, Blob& blob) {
  const double n = run.u_end - run.u_begin;
  const double mid = 0.5 * (run.u_begin + run.u_end - 1);
  const double sum_u = n * mid;
  blob.sum_u += sum_u;
  blob.sum_v += n * run.v;
  blob.sum_uu += n * mid * mid + n * (n * n - 1) / 12;
  blob.sum_uv += sum_u * run.v;
  blob.sum_vv += n * run.v * static_cast<double>(run.v);
  blob.area_px += run.u_end - run.u_begin;
  blob.u_min = std::min(blob.u_min, run.u_begin);
  blob.u_max = std::max(blob.u_max, run.u_end - 1);
  blob.v_min = std::min(blob.v_min, run.v);
  blob.v_max = std::max(blob.v_max, run.v);
}

}  // namespace

void GatherBlobs(const std::vector<Peak>& peaks, RunList& half, std::vector<int>& parent_of_run,
                 std::vector<Blob>& blobs) {
  Blob empty;
  empty.u_min = empty.v_min = std::numeric_limits<int>::max();
  empty.u_max = empty.v_max = -1;
  parent_of_run.clear();
  for (const Run& run : half.runs) parent_of_run.push_back(run.label);
  half.Connect();
  blobs.assign(static_cast<std::size_t>(half.num_labels), empty);
  for (std::size_t i = 0; i < half.runs.size(); ++i) {
    const Run& run = half.runs[i];
    Blob& blob = blobs[static_cast<std::size_t>(run.label)];
    const Peak& parent = peaks[static_cast<std::size_t>(parent_of_run[i])];
    blob.label = run.label;
    blob.parent = parent_of_run[i];
    blob.peak_dn = parent.peak_dn;
    blob.background_dn = parent.background_dn;
    blob.noise_dn = parent.noise_dn;
    blob.is_weak = parent.is_weak;
    AddRun(run, blob);
  }
}

}  // namespace stereomotion
