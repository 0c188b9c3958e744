#include "run_list.h"

#include <algorithm>
#include <cstddef>

namespace stereomotion {
namespace {

int FindRoot(std::vector<int>& parent, int i) {
  while (parent[static_cast<std::size_t>(i)] != i) {
    int& p = parent[static_cast<std::size_t>(i)];
    p = parent[static_cast<std::size_t>(p)];  // path halving
    i = p;
  }
  return i;
}

void Join(std::vector<int>& parent, int a, int b) {
  const int root_a = FindRoot(parent, a);
  const int root_b = FindRoot(parent, b);
  // The smaller index wins, so that a component's root is its first run.
  parent[static_cast<std::size_t>(std::max(root_a, root_b))] = std::min(root_a, root_b);
}

/// Tells whether a run lies wholly before the place where a run of the next row can touch it.
bool EndsBefore(const Run& above, const Run& run) {
  return above.v < run.v - 1 || (above.v == run.v - 1 && above.u_end < run.u_begin);
}

}  // namespace

void RunList::Start(int height_px) {
  runs.clear();
  num_labels = 0;
  row_begin.resize(static_cast<std::size_t>(height_px) + 1);
}

void RunList::IndexRows() {
  std::size_t row = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto v = static_cast<std::size_t>(runs[i].v);
    for (; row <= v; ++row) row_begin[row] = static_cast<int>(i);
  }
  std::fill(row_begin.begin() + static_cast<std::ptrdiff_t>(row), row_begin.end(),
            static_cast<int>(runs.size()));
}

void RunList::Connect() {
  const std::size_t count = runs.size();
  parent.resize(count);
  std::size_t above = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Run& run = runs[i];
    parent[i] = static_cast<int>(i);
    while (EndsBefore(runs[above], run)) ++above;  // ends at i itself
    for (std::size_t k = above; runs[k].v < run.v && runs[k].u_begin <= run.u_end; ++k) {
      Join(parent, static_cast<int>(k), static_cast<int>(i));
    }
  }
  num_labels = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const int root = FindRoot(parent, static_cast<int>(i));
    runs[i].label =
        root == static_cast<int>(i) ? num_labels++ : runs[static_cast<std::size_t>(root)].label;
  }
  IndexRows();
}

}  // namespace stereomotion
