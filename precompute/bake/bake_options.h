// Every choice that decides a bake's bytes.
#pragma once

#include "engine/scene/factored_brdf.h"

#include <cstddef>
#include <optional>

namespace relume {

struct BakeOptions {
    int terms = 4;         // K, 1 to 32: the most that a part gets; a diffuse one needs a single term
    int coefficients = 96; // N, 1 to 6 F²
    int mapSize = 48;      // S, 4 to 64
    DiskMapping mapping = DiskMapping::Orthographic;
    int faceSize = 64;        // F: 32 or 64
    int visibilitySize = 256; // 64, 128 or 256
    int transportSamples = 1; // 1, 4 or 16 light-map evaluations per lighting texel
    // Triangles that cast shadows, 0: all; the rest are simplified away.
    size_t occluderTriangles = 0;

    // Throws UsageError naming the option, its valid values and what was given.
    void validate() const;
};

} // namespace relume
