#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "check_findings.h"

namespace stereomotion::app {
namespace {

const char* WordOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::kGood:
      return "good";
    case Verdict::kMind:
      return "mind";
    case Verdict::kMend:
      return "mend";
  }
  return "";
}

// What must be done stands out.
const char* ShownWord(Verdict verdict) {
  return verdict == Verdict::kMend ? "MEND" : WordOf(verdict);
}

std::size_t Count(const std::vector<Finding>& findings, Verdict verdict) {
  return static_cast<std::size_t>(
      std::count_if(findings.begin(), findings.end(),
                    [&](const Finding& finding) { return finding.verdict == verdict; }));
}

std::string Summary(const std::vector<Finding>& findings) {
  const std::size_t mend = Count(findings, Verdict::kMend);
  const std::size_t mind = Count(findings, Verdict::kMind);
  const auto things = [](std::size_t count) {
    return fmt::format("{} {}", count, count == 1 ? "thing" : "things");
  };
  if (mend > 0) return fmt::format("NOT READY: {} to mend, {} to mind\n", things(mend), mind);
  if (mind > 0) return fmt::format("READY, with {} to mind\n", things(mind));
  return "READY\n";
}

}  // namespace

bool IsReady(const std::vector<Finding>& findings) { return Count(findings, Verdict::kMend) == 0; }

std::string FindingsText(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings) {
    const std::string where =
        finding.camera.empty() ? finding.topic : finding.topic + " " + finding.camera;
    text += fmt::format("{:<4}  {:<18} {}\n", ShownWord(finding.verdict), where, finding.text);
    if (!finding.advice.empty()) text += fmt::format("      {:<18} → {}\n", "", finding.advice);
  }
  return text + Summary(findings);
}

std::string FindingsJson(const std::vector<Finding>& findings) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const Finding& finding : findings) {
    const Json camera = finding.camera.empty() ? Json(nullptr) : Json(finding.camera);
    list.push_back({{"topic", finding.topic},
                    {"camera", camera},
                    {"verdict", WordOf(finding.verdict)},
                    {"text", finding.text},
                    {"advice", finding.advice},
                    {"values", finding.values}});
  }
  const Json document = {
      {"format", "stereomotion-check/1"}, {"ready", IsReady(findings)}, {"findings", list}};
  // File and device names need not be valid UTF-8.
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace stereomotion::app
