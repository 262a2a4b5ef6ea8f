// Shaders that take the place of built-in ones while a program runs.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace relume::vk {

struct ShaderReplacement {
    std::string name;                  // for messages
    std::span<const uint32_t> builtIn; // an array of shaders/*.h
    std::vector<uint32_t> spirv;
};

// All that C++ and the other stage must know of a shader, by what it is called: "binding 3" → "storage buffer
// {…}". Structs are told member by member, with offsets, names and types. Throws Error when `spirv` cannot be
// read.
std::map<std::string, std::string> describeInterface(std::span<const uint32_t> spirv);

// Throws Error, saying what differs of the shader called `name`, unless `spirv` can take the place of
// `builtIn`.
void expectSameInterface(const std::string& name, std::span<const uint32_t> builtIn,
                         std::span<const uint32_t> spirv);

} // namespace relume::vk
