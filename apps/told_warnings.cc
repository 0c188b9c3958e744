#include "told_warnings.h"

#include <fmt/format.h>

#include <algorithm>

namespace stereomotion::app {
namespace {

/// So many letters tell what a warning is about: "the cameras free-run against each other:". What
/// follows changes with the numbers ("before", "after").
constexpr std::size_t kTellingLetters = 40;

// The start of the text without its numbers: what kind of warning it is. Which camera it is about
// stays, though its name may be little else than numbers ("aravis:192.168.0.2").
std::string KeyOf(std::string text, const LiveReport& report) {
  std::string key;
  for (std::size_t i = 0; i < report.cameras.size(); ++i) {
    const std::string& uri = report.cameras[i].uri;
    const std::size_t at = uri.empty() ? std::string::npos : text.find(uri);
    if (at == std::string::npos) continue;
    if (at < kTellingLetters) key += fmt::format("{}, ", i);
    text.erase(at, uri.size());
  }
  constexpr const char* kOfNumbers = "0123456789.+-";
  const auto is_of_number = [&](char c) {
    return std::string_view(kOfNumbers).find(c) != std::string_view::npos;
  };
  text.erase(std::remove_if(text.begin(), text.end(), is_of_number), text.end());
  return key + text.substr(0, kTellingLetters);
}

}  // namespace

std::vector<std::string> ToldWarnings::New(const LiveReport& report) {
  std::vector<std::string> fresh;
  for (const std::string& warning : report.warnings) {
    if (keys_.insert(KeyOf(warning, report)).second) fresh.push_back(warning);
  }
  return fresh;
}

void AddRecorderWarnings(const RecorderCounts& counts, LiveReport& report) {
  if (!counts.problem.empty()) {
    report.warnings.push_back(counts.problem +
                              ": the recording has ended, what was recorded before is readable");
  } else if (counts.dropped > 0) {
    report.warnings.push_back(fmt::format(
        "{} pairs were not recorded: the disk is too slow for these cameras", counts.dropped));
  }
}

}  // namespace stereomotion::app
