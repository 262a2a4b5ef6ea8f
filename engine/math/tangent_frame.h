// Tangent frames from normals and tangents. GLSL twin: shaders/lib/tangent_frame.glsl.
#pragma once

#include "engine/math/vector.h"

namespace relume {

// An orthonormal, right-handed frame: t = n × s.
struct TangentFrame {
    vec3 s, t, n;

    // Coordinates of a world direction in the frame: z along the normal.
    vec3 toLocal(vec3 world) const { return {glm::dot(world, s), glm::dot(world, t), glm::dot(world, n)}; }
    vec3 toWorld(vec3 local) const { return local.x * s + local.y * t + local.z * n; }
};

// The frame of a unit normal, smooth over the sphere but at n = (0, -1, 0), where s = (1, 0, 0):
// the derivative of the stereographic projection from that pole (all-frequency relighting, 2004, 3.1).
TangentFrame tangentFrame(vec3 normal);

// Returns the mirror image of tangentFrame() in the plane y = 0: smooth over the sphere but at n = (0, 1, 0).
TangentFrame lowerTangentFrame(vec3 normal);

// Returns the frame of a unit normal whose s is the part of `tangent` that is orthogonal to it;
// tangentFrame(normal) where there is none.
TangentFrame tangentFrame(vec3 normal, vec3 tangent);

} // namespace relume
