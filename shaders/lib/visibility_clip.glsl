// The projection of the occluder into a cube face's image, for shaders that draw visibility.
#ifndef RELUME_LIB_VISIBILITY_CLIP_GLSL
#define RELUME_LIB_VISIBILITY_CLIP_GLSL

#include "shaders/lib/cubemap.glsl"
#include "shaders/shared/bake.h"

// Returns the clip position of a corner of the occluder, as `point` sees it. Depth is not stored, so z is free to
// clip what need not be drawn: 0 ≤ z leaves out what lies more than `belowHorizon` below the horizon, half of all
// texels, and z ≤ w what is nearer than about `nearDistance`, as the height above the horizon is at most √3 w there.
vec4 visibilityClip(vec3 corner, BakePoint point, uint face, VisibilityPush push) {
    const vec3 offset = corner - point.origin, local = offset * kFaceAxes[face];
    const float height = dot(point.normal, offset) + push.belowHorizon;
    return vec4(local.xy, height * (push.nearDistance / push.belowHorizon), local.z);
}

#endif
