// Bytes as text, for files that are part of another.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace relume {

// RFC 4648, padded, in one line.
std::string base64(std::span<const std::byte> bytes);

} // namespace relume
