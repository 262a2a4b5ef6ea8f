// Packing of light entries in tables. C++ unpacks them in engine/render/light_table.cpp.
#ifndef RELUME_LIB_LIGHT_PACKING_GLSL
#define RELUME_LIB_LIGHT_PACKING_GLSL
#include "shaders/shared/render.h"

PackedLight packLight(ivec3 q) { return PackedLight((uint(q.r) & 0xffffu) | uint(q.g) << 16, q.b); }

ivec3 unpackLight(PackedLight light) {
    const int redGreen = int(light.redGreen);
    return ivec3(bitfieldExtract(redGreen, 0, 16), redGreen >> 16, light.blue);
}

// Returns whether sums are computed anew rather than updated by the light's changes.
bool replacesSums(LightStats light, uint mode) {
    return light.changed >= (mode == kRelightFull ? 0 : mode == kRelightAuto ? light.kept : kUnknownChange);
}

#endif
