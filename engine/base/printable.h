// Text from files and command lines, made fit for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace relume {

// The text with every control character but line feeds spelled out, as \x1b: none can end a message early, or
// command a terminal.
std::string printable(std::string_view text);

} // namespace relume
