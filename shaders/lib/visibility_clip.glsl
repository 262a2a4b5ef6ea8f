// The projection of the occluder into a cube face's image, for shaders that draw visibility.
#ifndef RELUME_LIB_VISIBILITY_CLIP_GLSL
#define RELUME_LIB_VISIBILITY_CLIP_GLSL

#include "shaders/lib/cubemap.glsl"
#include "shaders/shared/bake.h"

// Returns the clip-space position of a corner of the occluder, seen from `point`. No depth is stored, so the depth
// planes clip other things: 0 ≤ z clips what lies further below the horizon than the margin, half of all that is in
// view, and z ≤ w clips what is nearer than the near distance. A height in view is at most √3 w, and the scale is
// small, so that nothing else is clipped.
vec4 visibilityClip(vec3 corner, BakePoint point, uint face, VisibilityPush push) {
    const vec3 offset = corner - point.origin, local = offset * kFaceAxes[face];
    const float height = dot(point.normal, offset);
    return vec4(local.xy, push.depthScale * (height + push.horizonMargin), local.z);
}

#endif
