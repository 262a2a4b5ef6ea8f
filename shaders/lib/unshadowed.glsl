// Unshadowed radiance from lit spheres, and the estimates of shadowed radiance that use it. Bindings 8 to 10 belong
// to this file. C++ twin of the estimates: precompute/residual/residual_estimate.h.
#ifndef RELUME_LIB_UNSHADOWED_GLSL
#define RELUME_LIB_UNSHADOWED_GLSL
#include "shaders/lib/polar_map.glsl"
#include "shaders/lib/tangent_frame.glsl"
#include "shaders/lib/texels.glsl"
#include "shaders/lib/view_grid.glsl"

layout(binding = 8) uniform sampler2DArray litSpheres;
TEXELS(9, uint, usamplerBuffer, SphereSlots, sphereSlots); // layer of litSpheres, by kernel and node
TEXELS(10, vec4, samplerBuffer, ViewGrid, viewGrid); // axis and side, two texels per node

float luminance(vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); }

// The four spheres around a view direction. For each: its node, the place of the mirror direction in it, and e^(2ia)
// for the azimuth a of its own view direction in the tangent frame.
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

// Returns the mirror direction at which a view direction `other` than the pixel's gives nearly the pixel's radiance.
// The pixel's own mirror direction keeps what is reflected in its place, but the closer both directions are to the
// horizon, the more the normal turns, and with it what is above the horizon: flat surfaces would show bands. At grazing
// angles the mirror direction therefore follows the view for a part of the way, `followed`, which blurs the reflection.
// All directions are unit vectors.
vec3 mirrorFor(vec3 other, vec3 view, vec3 mirror, float followed) {
    if (followed == 0) return mirror;
    const vec3 both = view + other; // `turned` is the mirror direction, turned as the view is
    const vec3 turned = mirror - dot(both, mirror) / (1 + dot(view, other)) * both + 2 * dot(view, mirror) * other;
    return normalize(mix(mirror, turned, followed));
}

// Returns the part of the way for mirrorFor(), which grows as the angle of incidence nears 90 degrees
// (docs/residual.md).
float followedPart(vec3 view, vec3 mirror) {
    const float kMost = 0.67, kFirstCosine = 0.4;
    return kMost * (1 - smoothstep(0, kFirstCosine, sqrt(max(0.5 + 0.5 * dot(view, mirror), 0))));
}

// Returns the phase of a view direction other than the pixel's, which has this mirror direction at another normal: the
// phase in the frame of this normal nearest to the pixel's own.
vec2 phaseAt(mat3 frame, vec3 view, vec3 mirror) {
    const vec3 between = view + mirror, own = vec3(0, 0, 1) * frame;
    const vec3 normal = dot(between, between) > 1e-6 ? normalize(between) : own;
    return phaseOf((tangentFrame(normal, vec3(1, 0, 0) * frame) * view).xy);
}

// Finds the spheres around a view direction. `frame` is the pixel's. Phases are for spheres with harmonics.
SpherePlaces spherePlaces(vec3 view, mat3 frame, vec3 mirror, bool hasHarmonics) {
    const GridCell cell = gridCell(view);
    const float followed = followedPart(view, mirror);
    SpherePlaces at;
    at.weights = vec4(1 - cell.place.x, cell.place.x, 1 - cell.place.x, cell.place.x) *
                 vec4(vec2(1 - cell.place.y), vec2(cell.place.y));
    for (int i = 0; i < 4; i++) {
        at.nodes[i] = int(cell.first) + (i / 2) * int(kGridSide) + i % 2;
        const vec3 axis = texelOf(viewGrid, 2 * at.nodes[i]).xyz;
        const vec3 own = mirrorFor(axis, view, mirror, followed);
        const vec2 place = polarPlace(axis, texelOf(viewGrid, 2 * at.nodes[i] + 1).xyz, own);
        at.places[i] = vec2(place.y + 0.5 / kSphereAzimuths, place.x);
        at.phases[i] = hasHarmonics ? phaseAt(frame, axis, own) : vec2(1, 0);
    }
    return at;
}

// Returns the place of a column, in [0, 1], and a row of map `band` in an image of maps of `rows` rows, one below the
// other. Maps are not interpolated with each other.
vec2 placeInBand(sampler2DArray maps, float column, float row, uint rows, uint band) {
    return vec2(column, (float(band * rows) + clamp(row, 0.5, float(rows) - 0.5)) / float(textureSize(maps, 0).y));
}

vec3 sphereAt(vec2 place, uint band, uint layer) {
    const vec2 inBand = placeInBand(litSpheres, place.x, place.y * kSphereRings, kSphereRings, band);
    return textureLod(litSpheres, vec3(inBand, layer), 0).rgb;
}

// Returns the unshadowed radiance of the layer whose spheres begin at `firstSlot`, from harmonic 0 and then the real
// and imaginary part of each further one.
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

// Returns the share of irradiance that reaches a point; 1 without light.
float litShare(vec3 irradiance, vec3 unshadowed) {
    const float all = luminance(unshadowed);
    return all > 0 ? clamp(luminance(irradiance) / all, 0, 1) : 1;
}

// Estimates radiance with signed terms, by the control variate T + r (E - S), clamped between a part of r E and E;
// with bounced light the upper limit is higher by as much as T exceeds S. `shadowed` is T, `share` r; `exact` and
// `terms` are the unshadowed E and S.
const float kLeastShare = 0.25;
vec3 differenceEstimate(vec3 shadowed, float share, vec3 exact, vec3 terms, bool isBounced) {
    const vec3 most = isBounced ? exact + max(shadowed - terms, 0) : exact;
    return clamp(shadowed + share * (exact - terms), kLeastShare * share * exact, most);
}

// Estimates radiance with nonnegative terms, by the ratio E D / S, where D / S is at most 1 and D, `direct`, is the
// direct light in T; with bounced light the rest of T is added, and what D exceeds S by. `leastView` is added to every
// view map: the more, the more the sums of the tuples, which do not depend on the view, give the ratio.
vec3 ratioEstimate(vec3 shadowed, vec3 direct, vec3 directTuples, vec3 exact, vec3 terms, vec3 unshadowedTuples,
                   bool isBounced, vec3 leastView) {
    const vec3 all = terms + leastView * unshadowedTuples, lit = direct + leastView * directTuples;
    const vec3 estimate = exact * clamp(lit / max(all, vec3(1e-30)), 0, 1);
    return isBounced ? estimate + max(shadowed - direct, 0) + max(direct - terms, 0) : estimate;
}

#endif
