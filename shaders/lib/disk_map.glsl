// Maps from the hemisphere to the unit square, and bilinear lookups in them.
// C++ twins: engine/math/disk_map.h, engine/scene/factored_brdf.h.
#ifndef RELUME_LIB_DISK_MAP_GLSL
#define RELUME_LIB_DISK_MAP_GLSL

const uint kOrthographicMapping = 0;
const uint kEqualAreaPolarMapping = 1;
const uint kEqualAreaMapping = 2;
const uint kPolarMapping = 3;

bool isPolar(uint mapping) { return mapping == kPolarMapping || mapping == kEqualAreaPolarMapping; }

vec2 diskMapCoordinates(uint mapping, vec3 local) {
    if (mapping == kOrthographicMapping) return 0.5 * local.xy + 0.5;
    if (mapping == kEqualAreaMapping) return local.xy * (0.5 / sqrt(1 + max(local.z, 0))) + 0.5;
    const float angle = dot(local.xy, local.xy) > 0 ? atan(local.y, local.x) : 0;
    const float radius = mapping == kPolarMapping ? min(1, length(local.xy)) : sqrt(max(0, 1 - local.z));
    return vec2(angle / (2 * 3.14159265358979) + 0.5, radius);
}

const float kGrazingCosine = 1e-3;
vec3 liftAboveHorizon(vec3 local) { return normalize(vec3(local.xy, max(local.z, kGrazingCosine))); }

// The four texels around a point of a map and their weights; clamped at the border, but polar maps wrap in x.
struct MapFootprint {
    ivec4 texels; // x0, y0, x1, y1
    vec2 weight;
};

MapFootprint mapFootprint(uint mapping, int size, vec3 local) {
    const vec2 place = diskMapCoordinates(mapping, local) * float(size) - 0.5;
    const vec2 corner = floor(place);
    ivec2 low = ivec2(corner), high = low + 1;
    if (isPolar(mapping)) {
        low.x = (low.x + size) % size;
        high.x = high.x % size;
    }
    low = clamp(low, ivec2(0), ivec2(size - 1));
    high = clamp(high, ivec2(0), ivec2(size - 1));
    return MapFootprint(ivec4(low, high), place - corner);
}

// Looks a map up bilinearly without the sampler: many devices round its weights to 8 bits, and CPU twins do not.
vec3 lookupMap(sampler2DArray maps, int layer, MapFootprint at) {
    const vec3 a = texelFetch(maps, ivec3(at.texels.xy, layer), 0).rgb;
    const vec3 b = texelFetch(maps, ivec3(at.texels.zy, layer), 0).rgb;
    const vec3 c = texelFetch(maps, ivec3(at.texels.xw, layer), 0).rgb;
    const vec3 d = texelFetch(maps, ivec3(at.texels.zw, layer), 0).rgb;
    return mix(mix(a, b, at.weight.x), mix(c, d, at.weight.x), at.weight.y);
}

#endif
