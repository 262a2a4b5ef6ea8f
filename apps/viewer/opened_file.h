// What files are that someone opens, and where what is baked of them is kept.
#pragma once

#include <filesystem>
#include <string>

namespace relume {

enum class FileKind { Bake, Bakeable, Environment, Light, Session };

// In small letters: ".obj".
std::string extensionOf(const std::filesystem::path& file);

// Returns the absolute path, by which files are told apart.
std::filesystem::path wholePath(const std::filesystem::path& file);

// By its name; of a .json by whether it has "parts", as scenes do, or "session". Throws Error for other
// files.
FileKind kindOf(const std::filesystem::path& file);

// Returns the scene that is shown for want of another, which it puts into the user's cache. Throws Error.
std::filesystem::path writeBuiltInScene();
constexpr const char* kBuiltInScene = "built-in scene"; // the name of that file, and of what is baked of it

// The bake of a mesh or scene file, as it and the files that a scene names are now, in the user's cache.
// Makes the folder. Throws Error.
std::filesystem::path bakePath(const std::filesystem::path& input);

} // namespace relume
