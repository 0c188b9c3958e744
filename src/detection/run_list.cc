#include <algorithm>

#include "segment_blobs.h"

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

}  // namespace

void RunList::Start(int height_px) {
  runs.clear();
  row_begin.assign(static_cast<std::size_t>(height_px) + 1, 0);
}

void RunList::Append(int v, int u_begin, int u_end, int label) {
  if (!runs.empty() && runs.back().v == v && runs.back().u_end == u_begin) {
    runs.back().u_end = u_end;
  } else {
    runs.push_back({v, u_begin, u_end, label});
  }
}

void RunList::Connect() {
  parent.resize(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) parent[i] = static_cast<int>(i);
  for (std::size_t v = 1; v + 1 < row_begin.size(); ++v) {
    int above = row_begin[v - 1];
    for (int i = row_begin[v]; i < row_begin[v + 1]; ++i) {
      const Run& run = runs[static_cast<std::size_t>(i)];
      while (above < row_begin[v] && runs[static_cast<std::size_t>(above)].u_end < run.u_begin)
        ++above;
      for (int k = above;
           k < row_begin[v] && runs[static_cast<std::size_t>(k)].u_begin <= run.u_end; ++k) {
        Join(parent, k, i);
      }
    }
  }
  num_labels = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const int root = FindRoot(parent, static_cast<int>(i));
    runs[i].label =
        root == static_cast<int>(i) ? num_labels++ : runs[static_cast<std::size_t>(root)].label;
  }
}

}  // namespace stereomotion
