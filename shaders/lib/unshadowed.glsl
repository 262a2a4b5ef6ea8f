// Unshadowed radiance from lit spheres, and the estimates of shadowed radiance that use it. Shaders have bindings 8 to
// 10 from here. C++ twin of the estimates: precompute/residual/residual_estimate.h.
#ifndef RELUME_LIB_UNSHADOWED_GLSL
#define RELUME_LIB_UNSHADOWED_GLSL
#include "shaders/lib/polar_map.glsl"
#include "shaders/lib/tangent_frame.glsl"
#include "shaders/lib/texels.glsl"
#include "shaders/lib/view_grid.glsl"

layout(binding = 8) uniform sampler2DArray litSpheres;
TEXELS(9, uint, usamplerBuffer, SphereSlots, sphereSlots); // of a layer's nodes: layers of the above
TEXELS(10, vec4, samplerBuffer, ViewGrid, viewGrid);       // axis and side, two texels a node

float luminance(vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); }

// The spheres around a view direction, with the place of a mirror direction in each, and e^(2ia) of the azimuth a of
// the sphere's own view direction in the tangent frame.
struct SpherePlaces {
    int nodes[4];
    vec2 places[4];
    vec2 phases[4];
    vec4 weights;
};

vec2 phaseOf(vec2 local) {
    const float squared = dot(local, local);
    return squared > 0 ? vec2(local.x * local.x - local.y * local.y, 2 * local.x * local.y) / squared : vec2(1, 0);
}

// The phase of a view direction other than the pixel's, which has the same mirror direction on another normal: in the
// frame of that, nearest to the pixel's own.
vec2 phaseAt(mat3 frame, vec3 view, vec3 mirror) {
    const vec3 between = view + mirror, own = vec3(0, 0, 1) * frame;
    const vec3 normal = dot(between, between) > 1e-6 ? normalize(between) : own;
    return phaseOf((tangentFrame(normal, vec3(1, 0, 0) * frame) * view).xy);
}

// `frame`: of the pixel. Phases are found where spheres have harmonics.
SpherePlaces spherePlaces(vec3 view, mat3 frame, vec3 mirror, bool hasHarmonics) {
    const GridCell cell = gridCell(view);
    SpherePlaces at;
    at.weights = vec4(1 - cell.place.x, cell.place.x, 1 - cell.place.x, cell.place.x) *
                 vec4(vec2(1 - cell.place.y), vec2(cell.place.y));
    for (int i = 0; i < 4; i++) {
        at.nodes[i] = int(cell.first) + (i / 2) * int(kGridSide) + i % 2;
        const vec3 axis = texelOf(viewGrid, 2 * at.nodes[i]).xyz;
        const vec2 place = polarPlace(axis, texelOf(viewGrid, 2 * at.nodes[i] + 1).xyz, mirror);
        at.places[i] = vec2(place.y + 0.5 / kSphereAzimuths, place.x);
        at.phases[i] = hasHarmonics ? phaseAt(frame, axis, mirror) : vec2(1, 0);
    }
    return at;
}

// Returns the place of a column, in [0, 1], and a row of a map in an image of maps of `rows` rows below each other.
// Between the maps nothing is mixed.
vec2 placeInBand(sampler2DArray maps, float column, float row, uint rows, uint band) {
    return vec2(column, (float(band * rows) + clamp(row, 0.5, float(rows) - 0.5)) / float(textureSize(maps, 0).y));
}

vec3 sphereAt(vec2 place, uint band, uint layer) {
    const vec2 inBand = placeInBand(litSpheres, place.x, place.y * kSphereRings, kSphereRings, band);
    return textureLod(litSpheres, vec3(inBand, layer), 0).rgb;
}

// Returns the unshadowed radiance of the layer whose spheres begin at `firstSlot`: harmonic 0, then the real and the
// imaginary part of each other.
vec3 unshadowedRadiance(uint firstSlot, uint harmonics, SpherePlaces at) {
    vec3 sum = vec3(0);
    for (int i = 0; i < 4; i++) {
        const uint layer = texelOf(sphereSlots, int(firstSlot) + at.nodes[i]).x;
        vec3 sphere = sphereAt(at.places[i], 0, layer);
        vec2 phase = vec2(1, 0);
        for (uint harmonic = 1; harmonic <= harmonics; harmonic++) {
            const vec2 step = at.phases[i];
            phase = vec2(phase.x * step.x - phase.y * step.y, phase.x * step.y + phase.y * step.x);
            sphere += phase.x * sphereAt(at.places[i], 2 * harmonic - 1, layer) -
                      phase.y * sphereAt(at.places[i], 2 * harmonic, layer);
        }
        sum += at.weights[i] * sphere;
    }
    return max(sum, 0); // a kernel without its highest frequencies can ring below zero
}

// The share of irradiance that reaches a point; 1 of no light.
float litShare(vec3 irradiance, vec3 unshadowed) {
    const float all = luminance(unshadowed);
    return all > 0 ? clamp(luminance(irradiance) / all, 0, 1) : 1;
}

// Estimates with signed terms: the control variate T + r (E - S), between a part of r E and E, or above that of bounced
// light as much as T is above S. `shadowed` is T, `share` r; `exact` and `terms` are the unshadowed E and S.
const float kLeastShare = 0.25;
vec3 differenceEstimate(vec3 shadowed, float share, vec3 exact, vec3 terms, bool isBounced) {
    const vec3 most = isBounced ? exact + max(shadowed - terms, 0) : exact;
    return clamp(shadowed + share * (exact - terms), kLeastShare * share * exact, most);
}

// Estimates with nonnegative terms: the ratio E T / S. Where all terms vanish in the view, the sums of the tuples give
// the ratio. Each channel's is clamped to a range around the luminance's, and that to a part of the irradiance's:
// errors of storage would color and blacken what little light reaches. Bounced light has colors of its own; where T is
// above S, it is what is above.
const float kLeastView = 1e-4, kLeastOfGray = 0.8, kMostOfGray = 1.25;
vec3 ratioEstimate(vec3 shadowed, vec3 tuples, vec3 exact, vec3 terms, vec3 unshadowedTuples, bool isBounced) {
    const vec3 all = terms + kLeastView * unshadowedTuples, lit = shadowed + kLeastView * tuples;
    const vec3 ratio = lit / max(all, vec3(1e-30));
    if (isBounced) return exact * clamp(ratio, 0, 1) + max(shadowed - terms, 0);
    const float gray = max(litShare(lit, all), kLeastShare * litShare(tuples, unshadowedTuples));
    return exact * min(clamp(ratio, kLeastOfGray * gray, kMostOfGray * gray), 1);
}

#endif
