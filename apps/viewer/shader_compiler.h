// Compiles shaders from source at run time, exactly as the build does.
#pragma once

#include "engine/vk/device.h"

namespace relume {

// Returns the folder of shader sources: the environment variable RELUME_SHADERS, or that of the sources from
// which this program was built.
std::filesystem::path shaderFolder();

// Compiles a shader with these macros defined, ignoring empty ones, to the SPIR-V that the build makes. The
// file name ends in .comp, .vert or .frag; includes are relative to the parent of its folder. Throws Error
// with the compiler's messages, file and line first.
std::vector<uint32_t> compileShader(const std::filesystem::path& source,
                                    std::span<const std::string_view> macros = {});

// Compiles the shaders of a frame (compare, display, light_*, relight_*, view_*) from `folder`, which must be
// named "shaders" because of includes, and makes programs created on `device` from now on use them. Returns
// how many differ from those in use. Throws Error, without changes, if one is missing, does not compile or
// has another interface than the C++ code expects.
size_t reloadShaders(vk::Device& device, const std::filesystem::path& folder);

} // namespace relume
