#include "segment_blobs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "multiversion.h"

namespace stereomotion {
namespace {

/// Marks the chunks of a row that hold a pixel above their threshold; tells whether there is any.
template <class T>
STEREOMOTION_INLINE bool MarkChunks(const T* __restrict row,
                                    const std::uint16_t* __restrict thresholds, int chunks,
                                    std::uint8_t* __restrict marks) {
  constexpr int kChunk = BackgroundMap::kChunk_px;
  std::uint8_t any = 0;
  for (int c = 0; c < chunks; ++c) {
    T highest = 0;
    for (int i = 0; i < kChunk; ++i) highest = std::max(highest, row[c * kChunk + i]);
    marks[c] = highest > thresholds[c] ? 1 : 0;
    any |= marks[c];
  }
  return any != 0;
}

STEREOMOTION_MULTIVERSION
bool MarkBright(const std::uint8_t* row, const std::uint16_t* thresholds, int chunks,
                std::uint8_t* marks) {
  return MarkChunks(row, thresholds, chunks, marks);
}

STEREOMOTION_MULTIVERSION
bool MarkBright(const std::uint16_t* row, const std::uint16_t* thresholds, int chunks,
                std::uint8_t* marks) {
  return MarkChunks(row, thresholds, chunks, marks);
}

template <class T>
T ClampToPixel(double value) {
  return static_cast<T>(std::clamp(value, 0.0, static_cast<double>(std::numeric_limits<T>::max())));
}

/// Appends the runs of [u_begin, u_end) above the threshold.
template <class T>
void AppendRuns(const T* row, int v, int u_begin, int u_end, T threshold, RunList& list) {
  for (int u = u_begin; u < u_end;) {
    while (u < u_end && row[u] <= threshold) ++u;
    const int start = u;
    while (u < u_end && row[u] > threshold) ++u;
    if (u > start) list.Append(v, start, u);
  }
}

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

template <class T>
void Segmenter::FindRuns(const ImageView& image, const BackgroundMap& background,
                         double threshold_sigma) {
  constexpr int kChunk = BackgroundMap::kChunk_px;
  const int whole_chunks = image.width_px / kChunk;
  const int chunks = (image.width_px + kChunk - 1) / kChunk;
  const int chunks_per_cell = background.cell_px / kChunk;
  thresholds_.resize(static_cast<std::size_t>(chunks));
  marks_.assign(static_cast<std::size_t>(chunks), 1);  // a last, narrower chunk is always searched
  above_.Start(image.height_px);
  for (int v = 0; v < image.height_px; ++v) {
    const T* row = image.Row<T>(v);
    if (v % background.cell_px == 0) {
      for (int c = 0; c < chunks; ++c) {
        const auto cell = static_cast<std::size_t>(v / background.cell_px * background.columns +
                                                   c / chunks_per_cell);
        thresholds_[static_cast<std::size_t>(c)] = ClampToPixel<T>(
            background.level_dn[cell] + threshold_sigma * background.noise_dn[cell]);
      }
    }
    const bool any = MarkBright(row, thresholds_.data(), whole_chunks, marks_.data());
    for (int c = any ? 0 : whole_chunks; c < chunks; ++c) {
      if (marks_[static_cast<std::size_t>(c)] == 0) continue;
      AppendRuns(row, v, c * kChunk, std::min((c + 1) * kChunk, image.width_px),
                 static_cast<T>(thresholds_[static_cast<std::size_t>(c)]), above_);
    }
    above_.FinishRow(v);
  }
  above_.Connect();
}

template <class T>
void Segmenter::CutAtHalfHeight(const ImageView& image, const BackgroundMap& background) {
  Blob empty;
  parents_.assign(static_cast<std::size_t>(above_.num_labels), empty);
  for (const Run& run : above_.runs) {
    Blob& parent = parents_[static_cast<std::size_t>(run.label)];
    const T* row = image.Row<T>(run.v);
    for (int u = run.u_begin; u < run.u_end; ++u) {
      if (row[u] <= parent.peak_dn) continue;
      parent.peak_dn = row[u];
      const auto cell = static_cast<std::size_t>(background.CellAt(u, run.v));
      parent.background_dn = background.level_dn[cell];
      parent.noise_dn = background.noise_dn[cell];
    }
  }
  half_.Start(image.height_px);
  parent_of_run_.clear();
  std::size_t next = 0;
  for (int v = 0; v < image.height_px; ++v) {
    for (; next < above_.runs.size() && above_.runs[next].v == v; ++next) {
      const Run& run = above_.runs[next];
      const Blob& parent = parents_[static_cast<std::size_t>(run.label)];
      AppendRuns(image.Row<T>(v), v, run.u_begin, run.u_end,
                 ClampToPixel<T>(0.5 * (parent.peak_dn + parent.background_dn)), half_);
      parent_of_run_.resize(half_.runs.size(), run.label);
    }
    half_.FinishRow(v);
  }
  half_.Connect();
}

void Segmenter::GatherBlobs() {
  Blob empty;
  empty.u_min = empty.v_min = std::numeric_limits<int>::max();
  empty.u_max = empty.v_max = -1;
  blobs_.assign(static_cast<std::size_t>(half_.num_labels), empty);
  for (std::size_t i = 0; i < half_.runs.size(); ++i) {
    const Run& run = half_.runs[i];
    Blob& blob = blobs_[static_cast<std::size_t>(run.label)];
    const Blob& parent = parents_[static_cast<std::size_t>(parent_of_run_[i])];
    blob.label = run.label;
    blob.parent = parent_of_run_[i];
    blob.peak_dn = parent.peak_dn;
    blob.background_dn = parent.background_dn;
    blob.noise_dn = parent.noise_dn;
    AddRun(run, blob);
  }
}

void Segmenter::Segment(const ImageView& image, const BackgroundMap& background,
                        double threshold_sigma) {
  if (image.type == PixelType::kGray8) {
    FindRuns<std::uint8_t>(image, background, threshold_sigma);
    CutAtHalfHeight<std::uint8_t>(image, background);
  } else {
    FindRuns<std::uint16_t>(image, background, threshold_sigma);
    CutAtHalfHeight<std::uint16_t>(image, background);
  }
  GatherBlobs();
}

}  // namespace stereomotion
