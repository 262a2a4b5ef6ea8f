// Compiles shaders from their sources while a program runs, as the build does.
#pragma once

#include "engine/vk/device.h"

namespace relume {

// Where the sources are: the environment variable RELUME_SHADERS, or the folder that this program was built
// from.
std::filesystem::path shaderFolder();

// SPIR-V of a shader with these macros defined, but for empty ones: word for word what the build makes of it.
// Its name ends in .comp, .vert or .frag, and its includes are found from the folder above its own. Throws
// Error with the compiler's messages, file and line first.
std::vector<uint32_t> compileShader(const std::filesystem::path& source,
                                    std::span<const std::string_view> macros = {});

// Compiles the shaders of a frame (compare, display, light_*, relight_*, view_*) from `folder`, which is
// called shaders as includes call it, and has programs that `device` makes from now on use them. Returns how
// many are not what was in use. Throws Error, and changes nothing, when one is missing, cannot be compiled or
// has another interface than the C++ code was built for.
size_t reloadShaders(vk::Device& device, const std::filesystem::path& folder);

} // namespace relume
