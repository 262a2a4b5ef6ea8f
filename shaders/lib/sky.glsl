// Radiance of the day sky. C++ twin: skyRadiance() in engine/light/day_sky.h.
#ifndef RELUME_SHADERS_LIB_SKY_GLSL
#define RELUME_SHADERS_LIB_SKY_GLSL
#include "shaders/shared/light.h"

vec3 rgbOf(vec3 Yxy) {
    const vec3 XYZ = vec3(Yxy.y, Yxy.z, 1 - Yxy.y - Yxy.z) * (Yxy.x / Yxy.z);
    return max(vec3(dot(XYZ, vec3(3.2406, -1.5372, -0.4986)), dot(XYZ, vec3(-0.9689, 1.8758, 0.0415)),
                    dot(XYZ, vec3(0.0557, -0.2040, 1.0570))),
               vec3(0));
}

vec3 skyRadiance(LightSky sky, vec3 direction) {
    if (direction.y <= 0) return sky.ground;
    // The half chord gives the angle; acos would lose digits near the sun.
    const float toSun = 2 * asin(min(0.5 * distance(direction, sky.sun), 1));
    const float cosine = dot(direction, sky.sun);
    const vec3 distribution = (1 + sky.a * exp(sky.b / direction.y)) *
                              (1 + sky.c * exp(sky.d * toSun) + sky.e * cosine * cosine);
    return rgbOf(sky.zenith * distribution);
}
#endif
