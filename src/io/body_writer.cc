#include "stereomotion/io/body_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "body_parameters.h"
#include "covariance_yaml.h"
#include "number_text.h"

namespace stereomotion {
namespace {

// A word that YAML takes for a text as it stands. A single letter may be a boolean (`Y`, `n`), a
// name with a point and a unit may not.
bool IsPlain(const std::string& text) {
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '.';
  };
  return std::isalpha(static_cast<unsigned char>(text.front())) != 0 &&
         std::all_of(text.begin(), text.end(), is_plain);
}

std::string CommentText(const std::string& comment) {
  if (comment.empty()) return "";
  std::string text = "# ";
  for (const char c : comment) text += c == '\n' ? std::string("\n# ") : std::string(1, c);
  return text + "\n";
}

std::string PointText(const Eigen::Vector3d& p_mm) {
  return "[" + NumberText(p_mm.x()) + ", " + NumberText(p_mm.y()) + ", " + NumberText(p_mm.z()) +
         "]";
}

std::string RodText(const Rod& rod) {
  std::string text = "  - name: " + QuotedText(rod.name) + "\n";
  text += "    ball_diameter_mm: " + NumberText(rod.ball_diameter_mm) + "\n    balls_mm: [";
  for (std::size_t i = 0; i < rod.balls_in_body_mm.size(); ++i) {
    if (i > 0) text += ",\n               ";
    text += PointText(rod.balls_in_body_mm[i]);
  }
  text += "]\n";
  if (rod.sigma_mm != 0) text += "    sigma_mm: " + NumberText(rod.sigma_mm) + "\n";
  return text;
}

}  // namespace

std::vector<std::string> BallParameterNames(const Body& body) {
  std::vector<std::string> names;
  for (const Rod& rod : body.rods) {
    for (std::size_t ball = 0; ball < rod.balls_in_body_mm.size(); ++ball) {
      for (const char axis : {'x', 'y', 'z'}) {
        names.push_back(fmt::format("{}.{}.{}_mm", rod.name, ball, axis));
      }
    }
  }
  return names;
}

std::string BodyYaml(const Body& body, const std::string& comment) {
  std::string text = CommentText(comment) + "format: stereomotion-body/1\n";
  if (!body.name.empty()) text += "name: " + QuotedText(body.name) + "\n";
  text += "rods:\n";
  for (const Rod& rod : body.rods) text += RodText(rod);
  if (body.covariance_mm2.size() == 0) return text;
  std::vector<std::string> names = BallParameterNames(body);
  for (std::string& name : names) name = IsPlain(name) ? name : QuotedText(name);
  return text + CovarianceYaml(names, body.covariance_mm2);
}

}  // namespace stereomotion
