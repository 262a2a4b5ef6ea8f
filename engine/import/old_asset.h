// Bakes of format version 2, whose META is JSON and which lack residuals.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace relume {

// Whether these bytes begin as a .relume file of version 2 does.
bool isOldAsset(std::span<const std::byte> bytes);

// The same bake in a file of this version, still without residuals. `name` stands for the file in errors.
// Throws Error as decodeAsset().
std::vector<std::byte> updateAsset(std::span<const std::byte> bytes, const std::string& name);

} // namespace relume
