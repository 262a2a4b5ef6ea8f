// Read-only tables, read by index: as texel buffers, which some devices read faster than storage buffers; in PORTABLE
// shaders as storage buffers, since Vulkan guarantees texel buffers of 65,536 texels only.
//
//     TEXELS(2, vec4, samplerBuffer, Vertices, vertices);   // binding, type of an element, sampler, block, name
//     texelOf(vertices, 7).xyz
//
// A texel has the components of the element's type; do not read others.
#ifndef RELUME_LIB_TEXELS_GLSL
#define RELUME_LIB_TEXELS_GLSL

#ifdef PORTABLE
#define TEXELS(number, type, sampler, block, name) layout(binding = number, std430) readonly buffer block { type name[]; }
#define texelOf(name, index) name[index]
#else
#define TEXELS(number, type, sampler, block, name) layout(binding = number) uniform sampler name
#define texelOf(name, index) texelFetch(name, index)
#endif

#endif
