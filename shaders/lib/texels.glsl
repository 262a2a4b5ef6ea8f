// Read-only tables, read by index: as texels through the texture unit, which some devices do faster than they load;
// in PORTABLE shaders as storage buffers, since Vulkan promises 65,536 texels only.
//
//     TEXELS(2, vec4, samplerBuffer, Vertices, vertices);   // binding, type of an element, sampler, block, name
//     texelOf(vertices, 7).xyz
//
// Components are those of the element's type; others must not be read.
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
