// Shaders that replace built-in ones while a program runs.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace relume::vk {

struct ShaderReplacement {
    std::string name;                  // for messages
    std::span<const uint32_t> builtIn; // an array of a generated shaders/*.h
    std::vector<uint32_t> spirv;
};

// Returns all that C++ and the other stages rely on in a shader, as text by name: "binding 3" → "storage
// buffer {…}". Structs are described member by member, with offsets, names and types. Throws Error if `spirv`
// cannot be read.
std::map<std::string, std::string> describeInterface(std::span<const uint32_t> spirv);

// Throws Error unless `spirv` can replace `builtIn`, of which it may read less. The text says what differs in
// the shader called `name`.
void expectSameInterface(const std::string& name, std::span<const uint32_t> builtIn,
                         std::span<const uint32_t> spirv);

} // namespace relume::vk
