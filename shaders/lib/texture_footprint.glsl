// Filtering of textures over a pixel's footprint. C++ twin: sampleFootprint() in engine/scene/texture.h.
#ifndef RELUME_LIB_TEXTURE_FOOTPRINT_GLSL
#define RELUME_LIB_TEXTURE_FOOTPRINT_GLSL

// Texture coordinates of a pixel's center, and their differences to the neighbors on the right and below.
struct Footprint {
    vec2 uv, right, down;
};

const float kMostTaps = 16, kMostFootprint = 1e6; // kMostFootprint is in texels

// Returns the mean over the ellipse around uv with `right` and `down` as conjugate diameters. It averages taps along
// the major axis, at the mip level whose texels are as wide as the minor axis, or as far apart as the taps. It does
// not use the device's own anisotropic filter, of which Vulkan specifies little: lavapipe takes derivatives from the
// neighbors' coordinates.
vec4 textureOver(sampler2DArray map, Footprint at) {
    if (textureQueryLevels(map) == 1) return textureLod(map, vec3(at.uv, 0), 0);
    const vec2 size = vec2(textureSize(map, 0).xy);
    const vec2 a = clamp(at.right * size, -kMostFootprint, kMostFootprint),
               b = clamp(at.down * size, -kMostFootprint, kMostFootprint);
    const float p = dot(a, a), q = dot(b, b), r = dot(a, b);
    const float major = sqrt(0.5 * (p + q + sqrt((p - q) * (p - q) + 4 * r * r)));
    const float minor = abs(a.x * b.y - a.y * b.x) / max(major, 1e-6);
    const float width = max(max(minor, major / kMostTaps), 1);
    const float taps = clamp(ceil(major / width), 1, kMostTaps);
    const float level = log2(width);
    const float turn = r == 0 && p == q ? 0 : 0.5 * atan(2 * r, p - q);
    const vec2 along = (cos(turn) * a + sin(turn) * b) / size;
    vec4 sum = vec4(0);
    for (float tap = 0.5; tap < taps; tap++)
        sum += textureLod(map, vec3(at.uv + (tap / taps - 0.5) * along, 0), level);
    return sum / taps;
}

#endif
