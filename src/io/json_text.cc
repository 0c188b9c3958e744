#include "json_text.h"

#include <fmt/format.h>

#include <cmath>

#include "csv_table.h"

namespace stereomotion {

using Json = nlohmann::ordered_json;

// File names need not be UTF-8; a name that is not must not cost the whole file.
std::string JsonText(const Json& json, const std::string& indent) {
  bool nested = false;
  for (const Json& child : json) nested = nested || (json.is_structured() && child.is_structured());
  if (!nested) return json.dump(-1, ' ', false, Json::error_handler_t::replace);
  const std::string inner = indent + "  ";
  std::string text;
  for (const auto& [key, child] : json.items()) {
    text += (text.empty() ? "\n" : ",\n") + inner;
    if (json.is_object()) text += JsonText(Json(key)) + ": ";
    text += JsonText(child, inner);
  }
  return (json.is_object() ? "{" : "[") + text + "\n" + indent + (json.is_object() ? "}" : "]");
}

Json JsonNumber(double number) {
  if (!std::isfinite(number)) return nullptr;
  return ParseNumber(fmt::format("{:.10g}", number + 0.0)).value_or(0);
}

Json JsonVector(const Eigen::VectorXd& vector) {
  Json list = Json::array();
  for (const double number : vector) list.push_back(JsonNumber(number));
  return list;
}

Json JsonMatrix(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) rows.push_back(JsonVector(matrix.row(i)));
  return rows;
}

}  // namespace stereomotion
