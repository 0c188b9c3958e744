#pragma once

#include <string>

namespace stereomotion::testing {

/// Reads a document as XML would: what is wrong with it (with the place), or nothing. Elements must
/// nest, attributes be quoted and come once, entities be the five of XML or numbers, and no control
/// characters appear.
std::string FindXmlError(const std::string& text);

/// The text of a well-formed document without tags, styles and entities.
std::string XmlText(const std::string& text);

}  // namespace stereomotion::testing
