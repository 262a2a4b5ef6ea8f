// What a surface reflects that nothing shadows, from lit spheres, and the estimates of what is shadowed that are made
// of it. C++ twins: mixedSpheres() in precompute/reference/lit_sphere_twin.h, residual_twin.h.
#ifndef RELUME_LIB_UNSHADOWED_GLSL
#define RELUME_LIB_UNSHADOWED_GLSL
#include "shaders/lib/polar_map.glsl"
#include "shaders/lib/view_grid.glsl"

float luminance(vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); }

// Where the spheres around a view direction have a mirror direction.
struct SpherePlaces {
    int nodes[4];
    vec2 places[4];
    vec4 weights;
};

SpherePlaces spherePlaces(samplerBuffer grid, vec3 view, vec3 mirror) {
    const GridCell cell = gridCell(view);
    SpherePlaces at;
    at.weights = vec4(1 - cell.place.x, cell.place.x, 1 - cell.place.x, cell.place.x) *
                 vec4(vec2(1 - cell.place.y), vec2(cell.place.y));
    for (int i = 0; i < 4; i++) {
        at.nodes[i] = int(cell.first) + (i / 2) * int(kGridSide) + i % 2;
        const vec2 place = polarPlace(texelFetch(grid, 2 * at.nodes[i]).xyz, texelFetch(grid, 2 * at.nodes[i] + 1).xyz,
                                      mirror);
        at.places[i] = vec2(place.y + 0.5 / kSphereAzimuths, place.x);
    }
    return at;
}

// Unshadowed radiance of the layer whose spheres begin at `firstSlot`.
vec3 unshadowedRadiance(sampler2DArray spheres, usamplerBuffer slots, uint firstSlot, SpherePlaces at) {
    vec3 sum = vec3(0);
    for (int i = 0; i < 4; i++)
        sum += at.weights[i] *
               textureLod(spheres, vec3(at.places[i], texelFetch(slots, int(firstSlot) + at.nodes[i]).x), 0).rgb;
    return max(sum, 0); // a kernel without its highest frequencies can ring below zero
}

// The share of irradiance that reaches a point; 1 of no light.
float litShare(vec3 irradiance, vec3 unshadowed) {
    const float all = luminance(unshadowed);
    return all > 0 ? clamp(luminance(irradiance) / all, 0, 1) : 1;
}

// Terms that can be negative: the control variate T + r (E - S), between a part of r E and E. `shadowed` is T, by terms
// that know of shadows, `share` r, `exact` and `terms` E and S, what nothing shadows.
const float kLeastShare = 0.25;
vec3 differenceEstimate(vec3 shadowed, float share, vec3 exact, vec3 terms) {
    return clamp(shadowed + share * (exact - terms), kLeastShare * share * exact, exact);
}

// Terms that cannot: the ratio E T / S. Where no term sees anything, the shares of the tuples' sums decide.
const float kLeastView = 1e-4;
vec3 ratioEstimate(vec3 shadowed, vec3 tuples, vec3 exact, vec3 terms, vec3 unshadowedTuples) {
    const vec3 all = terms + kLeastView * unshadowedTuples;
    return exact * clamp((shadowed + kLeastView * tuples) / max(all, vec3(1e-30)), 0, 1);
}

#endif
