// Conversion of bakes of format version 2, whose META is JSON and which lack residuals.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace relume {

// Returns whether the bytes begin as a .relume file of version 2 does.
bool isOldAsset(std::span<const std::byte> bytes);

// Returns the same bake as a file of the current version, still without residuals. `name` names the file in
// errors. Throws Error as decodeAsset() does.
std::vector<std::byte> updateAsset(std::span<const std::byte> bytes, const std::string& name);

} // namespace relume
