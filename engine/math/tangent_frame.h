// Tangent frames from normals and tangents. GLSL twin: shaders/lib/tangent_frame.glsl.
#pragma once

#include "engine/math/vector.h"

namespace relume {

// An orthonormal, right-handed frame: t = n × s.
struct TangentFrame {
    vec3 s, t, n;

    // Returns the coordinates of a world direction in the frame; z is along the normal.
    vec3 toLocal(vec3 world) const { return {glm::dot(world, s), glm::dot(world, t), glm::dot(world, n)}; }
    vec3 toWorld(vec3 local) const { return local.x * s + local.y * t + local.z * n; }
};

// Returns the frame of a unit normal. It is smooth over the sphere except at n = (0, -1, 0), where s = (1, 0,
// 0): s is the derivative of the stereographic projection from that pole (section 3.1 of the paper).
TangentFrame tangentFrame(vec3 normal);

// Returns the mirror image of tangentFrame() in the plane y = 0: smooth except at n = (0, 1, 0).
TangentFrame lowerTangentFrame(vec3 normal);

// Returns the frame of a unit normal whose s is the part of `tangent` orthogonal to it, or
// tangentFrame(normal) if that part vanishes.
TangentFrame tangentFrame(vec3 normal, vec3 tangent);

} // namespace relume
