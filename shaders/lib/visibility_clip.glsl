// The projection of the occluder into a cube face's image, for shaders that draw visibility.
#ifndef RELUME_LIB_VISIBILITY_CLIP_GLSL
#define RELUME_LIB_VISIBILITY_CLIP_GLSL

#include "shaders/lib/cubemap.glsl"

// Returns the clip position of a corner that lies at `offset` from the point. Depth is not stored; z only clips at the near plane, since 0 ≤ z ≤ w where
// z = w - near.
vec4 visibilityClip(vec3 offset, uint face, float nearDistance) {
    const vec3 local = offset * kFaceAxes[face];
    return vec4(local.xy, local.z - nearDistance, local.z);
}

#endif
