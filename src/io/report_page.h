#pragma once

#include <string>
#include <string_view>

namespace stereomotion {

/// Opens a self-contained page (well-formed XML, too): style, heading, and a line about its making.
/// All texts are escaped here.
std::string PageHead(std::string_view title, std::string_view heading, std::string_view meta);

/// Closes what `PageHead` has opened.
std::string PageEnd();

}  // namespace stereomotion
