#pragma once

#include <string>

namespace stereomotion {

/// Spells a number with as few digits as give it back exactly, with a decimal point whatever the
/// locale and −0 as 0. Throws std::invalid_argument for what is not finite: no file can hold it.
std::string NumberText(double number);

/// Quotes a text for YAML and TOML, where a plain word will not do.
std::string QuotedText(const std::string& text);

}  // namespace stereomotion
