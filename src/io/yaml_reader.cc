#include "yaml_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

#include "read_text.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/suggest.h"

namespace stereomotion {
namespace {

std::string Join(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string Shown(double number) {
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream << number;
  return stream.str();
}

}  // namespace

YamlReader YamlReader::Load(const std::filesystem::path& file) {
  const std::string text = ReadText(file, "a YAML file");
  try {
    return {file, YAML::Load(text), "", 1};
  } catch (const YAML::Exception& error) {
    throw UserError(file.string() + ":" + std::to_string(error.mark.line + 1) +
                    ": is not valid YAML (" + error.msg + ")");
  }
}

std::string YamlReader::Place() const {
  return file_.string() + ":" + std::to_string(line_) + (path_.empty() ? "" : ": " + path_);
}

void YamlReader::Fail(const std::string& found, const std::string& expected) const {
  throw UserError(Place() + ": found " + found + ", expected " + expected);
}

std::string YamlReader::Found() const {
  if (node_.IsMap()) return "a map";
  if (node_.IsSequence()) return "a list of " + std::to_string(node_.size());
  if (node_.IsScalar()) return "'" + node_.Scalar() + "'";
  return "nothing";
}

std::string YamlReader::KeyPath(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

YamlReader YamlReader::Child(const YAML::Node& node, const std::string& path) const {
  const int line = node.Mark().line;
  return {file_, node, path, line >= 0 ? line + 1 : line_};
}

void YamlReader::RequireKeys(const std::vector<std::string>& known) const {
  if (!node_.IsMap()) Fail(Found(), "a map with " + Join(known));
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "?";
    const YamlReader at = Child(entry.first, KeyPath(key));
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      throw UserError(at.Place() + ": unknown key '" + key + "', expected one of " + Join(known) +
                      DidYouMean(key, known));
    }
    if (!seen.insert(key).second) throw UserError(at.Place() + ": the key stands here twice");
  }
}

bool YamlReader::Has(const std::string& key) const {
  return node_.IsMap() && node_[key].IsDefined();
}

std::vector<std::string> YamlReader::Keys() const {
  std::vector<std::string> keys;
  if (!node_.IsMap()) return keys;
  for (const auto& entry : node_) {
    if (entry.first.IsScalar()) keys.push_back(entry.first.Scalar());
  }
  return keys;
}

YamlReader YamlReader::Required(const std::string& key) const {
  if (!node_.IsMap()) Fail(Found(), "a map with the key '" + key + "'");
  if (!Has(key)) throw UserError(Place() + ": the key '" + key + "' is missing");
  return Child(node_[key], KeyPath(key));
}

std::optional<YamlReader> YamlReader::Optional(const std::string& key) const {
  if (!Has(key)) return std::nullopt;
  return Child(node_[key], KeyPath(key));
}

std::vector<YamlReader> YamlReader::Items() const {
  if (!node_.IsSequence()) Fail(Found(), "a list");
  std::vector<YamlReader> items;
  for (std::size_t i = 0; i < node_.size(); ++i) {
    items.push_back(Child(node_[i], path_ + "[" + std::to_string(i) + "]"));
  }
  return items;
}

double YamlReader::Number() const {
  double number = 0;
  if (!node_.IsScalar()) Fail(Found(), "a number");
  if (!YAML::convert<double>::decode(node_, number)) Fail(Found(), "a number");
  if (!std::isfinite(number)) Fail(Found(), "a finite number");
  return number;
}

double YamlReader::Positive() const {
  const double number = Number();
  if (!(number > 0)) Fail(Shown(number), "a number above 0");
  return number;
}

double YamlReader::NotNegative() const {
  const double number = Number();
  if (number < 0) Fail(Shown(number), "0 or more");
  return number;
}

int YamlReader::Integer(int smallest, int largest) const {
  const double number = Number();
  if (number != std::floor(number) || number < smallest || number > largest) {
    Fail(Shown(number),
         "a whole number from " + std::to_string(smallest) + " to " + std::to_string(largest));
  }
  return static_cast<int>(number);
}

std::string YamlReader::Text() const {
  if (!node_.IsScalar()) Fail(Found(), "a text");
  return node_.Scalar();
}

std::string YamlReader::Name() const {
  const std::string name = Text();
  const auto bad = name.find_first_of(",\"'\n\r\t/\\");
  if (name.empty() || name == "." || name == ".." || bad != std::string::npos) {
    Fail(Found(), "a name without commas, quotes or slashes");
  }
  return name;
}

std::vector<double> YamlReader::Numbers() const {
  std::vector<double> numbers;
  for (const YamlReader& item : Items()) numbers.push_back(item.Number());
  return numbers;
}

std::vector<double> YamlReader::Numbers(std::size_t count) const {
  if (!node_.IsSequence() || node_.size() != count) {
    Fail(Found(), "a list of " + std::to_string(count) + " numbers");
  }
  return Numbers();
}

Eigen::Vector3d YamlReader::Vector3() const {
  const std::vector<double> xyz = Numbers(3);
  return {xyz[0], xyz[1], xyz[2]};
}

}  // namespace stereomotion
