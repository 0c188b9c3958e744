#pragma once

#include <cstdint>
#include <vector>

namespace stereomotion {

/// Finds the median difference of successive times; 0 for fewer than two.
std::int64_t MedianPeriodNs(const std::vector<std::int64_t>& times_ns);

/// Pairs two ascending lists of times one to one: a pair is two times that are each other's nearest
/// and differ by less than `tolerance_ns`. Returns for every left time the place of its right
/// partner, or −1. The relation is symmetric in left and right.
std::vector<std::int64_t> PairByTime(const std::vector<std::int64_t>& left_ns,
                                     const std::vector<std::int64_t>& right_ns,
                                     std::int64_t tolerance_ns);

}  // namespace stereomotion
