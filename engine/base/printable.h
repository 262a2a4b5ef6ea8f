// Escaping of text from files and command lines before it reaches a terminal.
#pragma once

#include <string>
#include <string_view>

namespace relume {

// Returns the text with every control character except line feeds escaped, as in \x1b, so that none can end a
// message early or command a terminal.
std::string printable(std::string_view text);

} // namespace relume
