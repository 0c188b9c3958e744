#include "stereomotion/io/run_analysis.h"

#include <nlohmann/json.hpp>

#include "read_text.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/write_file.h"

namespace stereomotion {

void NoteAnalysis(const std::filesystem::path& run, const std::vector<std::string>& command,
                  const std::string& filter) {
  using Json = nlohmann::ordered_json;
  const std::filesystem::path file = run / "run.json";
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return;
  Json json = Json::parse(ReadText(file, "the run.json of a run"), nullptr, false);
  if (!json.is_object())
    throw UserError(file.string() + ": found no JSON object, expected run.json");
  json["analysis"] = {{"command", command},
                      {"filter", filter.empty() ? Json(nullptr) : Json(filter)}};
  WriteFileAtomically(file, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace stereomotion
