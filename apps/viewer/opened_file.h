// Recognizes the kind of files that a user opens, and names the files of their bakes.
#pragma once

#include <filesystem>
#include <string>

namespace relume {

// The kinds of files that can be opened; Bakeable ones are meshes and scenes.
enum class FileKind { Bake, Bakeable, Environment, Light, Session };

// Returns the extension in lower case: ".obj".
std::string extensionOf(const std::filesystem::path& file);

// Returns the absolute path, by which files are compared.
std::filesystem::path wholePath(const std::filesystem::path& file);

// Returns the kind by the file's name; of a .json by its content: "parts" for scenes, "session" for sessions.
// Throws Error for other files.
FileKind kindOf(const std::filesystem::path& file);

// Writes the scene that is shown when no file is given, into the user's cache; returns its path. Throws
// Error.
std::filesystem::path writeBuiltInScene();
constexpr const char* kBuiltInScene = "built-in scene"; // name of that file and of its bake

// Returns the path, in the user's cache, of the bake of a mesh or scene file. It depends on the path, size
// and modification time of the file, and of the files that a scene or a .gltf file names. Makes the folder.
// Throws Error.
std::filesystem::path bakePath(const std::filesystem::path& input);

} // namespace relume
