#include "xml_check.h"

#include <algorithm>
#include <regex>
#include <set>
#include <vector>

namespace stereomotion::testing {
namespace {

const std::regex kEntity(R"(&(amp|lt|gt|quot|apos|#\d+);)");

std::string At(std::size_t place, const std::string& what, const std::string& text) {
  return what + " at: " + text.substr(place, 60);
}

bool GoodCharacters(const std::string& text) {
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') return false;
  }
  const auto ampersands = std::count(text.begin(), text.end(), '&');
  return ampersands == std::distance(std::sregex_iterator(text.begin(), text.end(), kEntity), {});
}

// What stands between the name of a tag and its end. By hand: std::regex recurses by character, and
// a path has 40 000 of them.
bool GoodAttributes(const std::string& rest) {
  std::set<std::string> seen;
  std::size_t place = rest.find_first_not_of(" \n");
  while (place != std::string::npos) {
    const std::size_t equal = rest.find("=\"", place);
    if (equal == std::string::npos || equal == place) return false;
    const std::string name = rest.substr(place, equal - place);
    if (name.find_first_of(" \n\"'<>/=") != std::string::npos) return false;
    const std::size_t end = rest.find('"', equal + 2);
    if (end == std::string::npos || !seen.insert(name).second) return false;
    if (rest.substr(equal, end - equal).find('<') != std::string::npos) return false;
    place = rest.find_first_not_of(" \n", end + 1);
    if (place == end + 1) return false;  // no space between two attributes
  }
  return true;
}

}  // namespace

std::string FindXmlError(const std::string& text) {
  if (!GoodCharacters(text)) return "a control character or a bare &";
  static const std::regex name(R"(/?[A-Za-z][\w:-]*)");
  std::vector<std::string> open;
  std::size_t place = text.rfind("<!DOCTYPE html>", 0) == 0 ? text.find('>') + 1 : 0;
  while ((place = text.find('<', place)) != std::string::npos) {
    const std::size_t end = text.find('>', place);
    if (end == std::string::npos) return At(place, "an open tag", text);
    std::string tag = text.substr(place + 1, end - place - 1);
    const bool empty = !tag.empty() && tag.back() == '/';
    if (empty) tag.pop_back();
    const std::string word = tag.substr(0, tag.find_first_of(" \n"));
    if (!std::regex_match(word, name)) return At(place, "no tag", text);
    if (word[0] == '/') {
      if (open.empty() || open.back() != word.substr(1)) return At(place, "nesting", text);
      open.pop_back();
    } else {
      if (!GoodAttributes(tag.substr(word.size()))) return At(place, "attributes", text);
      if (!empty) open.push_back(word);
    }
    place = end + 1;
  }
  return open.empty() ? "" : "never closed: " + open.back();
}

std::string XmlText(const std::string& text) {
  std::string plain = text;
  const std::size_t style = plain.find("<style>"), end = plain.find("</style>");
  if (style != std::string::npos) plain.erase(style, end - style);
  std::string result;
  bool inside = false;
  for (const char c : plain) {
    if (c == '<') inside = true;
    if (!inside) result += c;
    if (c == '>') inside = false;
  }
  const std::pair<const char*, const char*> entities[] = {
      {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}, {"&amp;", "&"}};
  for (const auto& [entity, character] : entities) {
    for (std::size_t at = 0; (at = result.find(entity, at)) != std::string::npos; ++at) {
      result.replace(at, std::string(entity).size(), character);
    }
  }
  return result;
}

}  // namespace stereomotion::testing
