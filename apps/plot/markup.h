// Text in markup: SVG and HTML.
#pragma once

#include <string>
#include <string_view>

namespace relume {

// UTF-8 as it may stand between tags and in attributes; control characters, which neither has, become spaces.
std::string escapedMarkup(std::string_view text);

} // namespace relume
