#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

namespace stereomotion::app {

/// More threads than that are a slip of the finger, and each costs memory.
constexpr std::int64_t kMostThreads = 256;
/// Frame counts beyond that are no recording's.
constexpr std::int64_t kMostFrames = 1'000'000'000'000;

/// Checks that an option's value is a number from `lowest` to `highest`; says what was found and
/// what was expected.
CLI::Validator NumberWithin(double lowest, double highest);

/// The same for whole numbers.
CLI::Validator WholeNumberWithin(std::int64_t lowest, std::int64_t highest);

/// Accepts any text but none: an empty name is a shell variable that was not set.
/// `what` is expected: "a file".
CLI::Validator NotEmpty(const std::string& what = "a file");

}  // namespace stereomotion::app
