// What files are that someone opens, and where what is baked of them is kept.
#pragma once

#include <filesystem>

namespace relume {

enum class FileKind { Bake, Bakeable, Environment, Light };

// By its name; of a .json by whether it has "parts", as scenes do. Throws Error for other files.
FileKind kindOf(const std::filesystem::path& file);

// The bake of a mesh or scene file, as it is now, in the user's cache; empty: the built-in scene. Makes the
// folder. Throws Error.
std::filesystem::path bakePath(const std::filesystem::path& input);

} // namespace relume
