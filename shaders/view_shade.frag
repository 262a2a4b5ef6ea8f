#version 460
// Computes the radiance reflected at the point where a pixel's ray meets the triangle that it sees: view maps of the
// bound layers, looked up in the local view direction, times the interpolated tuple. C++ twins: lookupMap() in
// engine/scene/factored_brdf.h, paintWeights() in engine/render/appearance.h. The sampler does the bilinear lookup:
// devices may round its weights to 8 bits, which is invisible here, though a bake could not tolerate it. Buffers are
// read as texels, which on lavapipe takes a fraction of the time of loads.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/barycentric.glsl"
#include "shaders/lib/disk_map.glsl"
#include "shaders/lib/normal_map.glsl"
#include "shaders/lib/tangent_frame.glsl"
#include "shaders/lib/texels.glsl"
#include "shaders/lib/texture_footprint.glsl"
#include "shaders/lib/unshadowed.glsl"
#include "shaders/shared/light.h"
#include "shaders/shared/render.h"

layout(constant_id = 0) const uint kTerms = 4;
layout(constant_id = 1) const bool kGray = false; // whether all view maps are gray: ViewMapTexture
layout(constant_id = 2) const uint kLook = 0;
layout(constant_id = 3) const bool kAllTerms = true; // else the first push.terms only
layout(constant_id = 4) const uint kDrawn = 0; // how the residual is added (unshadowed.glsl), and kShadow
layout(constant_id = 7) const uint kHarmonics = 0; // most harmonics of a bound layer's lit spheres
layout(constant_id = 8) const bool kTangents = false; // frames follow from vertex tangents; else from normals
const uint kEstimate = kDrawn & ~kShadow;
const bool kTellsDirect = (kEstimate & kDirectShares) != 0;
const bool kShowsShadow = (kDrawn & kShadow) != 0;
const uint kQuads = (kTerms + 3) / 4;
const bool kWholeQuads = kTerms % 4 == 0;
const uint kLayerImages = kGray ? kQuads : (3 * kTerms + 3) / 4;
layout(push_constant, scalar) uniform Push { ViewShadePush push; };
#ifdef MULTISAMPLED
#include "shaders/lib/pixel_samples.glsl"
layout(constant_id = 6) const bool kEdges = false; // shades pixels with several groups of samples; else the others
#else
layout(binding = 0) uniform usampler2DArray triangleIds; // triangle ids; 0: none
#endif
TEXELS(1, uvec4, usamplerBuffer, Triangles, triangles); // three corners, fourth component unused
TEXELS(2, vec4, samplerBuffer, Vertices, vertices);     // ViewVertex: kVertexTexels
#ifdef PORTABLE
layout(binding = 3, std430) readonly buffer Tuples { float tuples[]; };
layout(binding = 15, std430) readonly buffer FillTuples { float fillTuples[]; };
#define FOUR_OF(from, i) vec4(from[4 * (i)], from[4 * (i) + 1], from[4 * (i) + 2], from[4 * (i) + 3])
#else
layout(binding = 3) uniform samplerBuffer tuples;
layout(binding = 15) uniform samplerBuffer fillTuples; // the same of the fill
#define FOUR_OF(from, i) texelFetch(from, i)
#endif
TEXELS(16, uint, usamplerBuffer, Shares, directShares); // MaterialSet::directShares, if kTellsDirect
layout(binding = 4) uniform sampler2DArray viewMaps;   // ViewMapTexture
layout(binding = 5, scalar) readonly buffer Layers {
    ViewDetail detail;
    ViewLayer layers[];
};
layout(binding = 6) uniform sampler2DArray baseColor;
layout(binding = 7) uniform sampler2DArray materialMap;
layout(binding = 13) uniform sampler2DArray normalMap;
layout(binding = 14) uniform sampler2DArray emissionMap;
layout(binding = 11) uniform sampler2DArray unshadowedTuples; // three images per four terms
TEXELS(12, vec4, samplerBuffer, IrradianceWeights, irradianceWeights); // laid out as tuples of whole quads

layout(location = 0) out vec4 radiance;

// Four terms of three channels, as they are stored; terms beyond K are zero.
struct Quad {
    vec4 a, b, c; // rgbr, gbrg, brgb
};

vec3 sumOf(Quad q) {
    return vec3(q.a.x + q.a.w + q.b.z + q.c.y, q.a.y + q.b.x + q.b.w + q.c.z, q.a.z + q.b.y + q.c.x + q.c.w);
}

Quad mapsOf(vec2 place, uint firstMap, uint quad) {
    if (kGray) {
        const vec4 m = textureLod(viewMaps, vec3(place, firstMap + quad), 0);
        return Quad(m.xxxy, m.yyzz, m.zwww);
    }
    Quad q = Quad(vec4(0), vec4(0), vec4(0));
    q.a = textureLod(viewMaps, vec3(place, firstMap + 3 * quad), 0);
    if (3 * quad + 1 < kLayerImages) q.b = textureLod(viewMaps, vec3(place, firstMap + 3 * quad + 1), 0);
    if (3 * quad + 2 < kLayerImages) q.c = textureLod(viewMaps, vec3(place, firstMap + 3 * quad + 2), 0);
    return q;
}

// Sets all but the first `terms` terms to zero.
void keepTerms(inout Quad q, uint terms) {
    const vec4 kept = vec4(lessThan(uvec4(0, 1, 2, 3), uvec4(terms)));
    q.a *= kept.xxxy;
    q.b *= kept.yyzz;
    q.c *= kept.zwww;
}

// Returns the four values that begin at component `shift` of two consecutive texels.
vec4 window(vec4 a, vec4 b, uint shift) {
    return shift == 0 ? a : shift == 1 ? vec4(a.yzw, b.x) : shift == 2 ? vec4(a.zw, b.xy) : vec4(a.w, b.xyz);
}

// Adds four terms of a vertex's tuple, from `tuples` or `fillTuples`. Unless K is a multiple of four they begin
// anywhere in a texel.
#define ADD_TUPLE(sum, weight, from, vertex, quad)                                                                     \
    {                                                                                                                  \
        const uint first = 3 * ((vertex) * kTerms + 4 * (quad)), shift = kWholeQuads ? 0 : first % 4;                  \
        const uint end = kWholeQuads ? 12 : shift + 3 * min(4, kTerms - 4 * (quad));                                   \
        vec4 texels[4];                                                                                                \
        for (uint i = 0; i < 4; i++) texels[i] = 4 * i < end ? FOUR_OF(from, int(first / 4 + i)) : vec4(0);            \
        Quad values = Quad(window(texels[0], texels[1], shift), window(texels[1], texels[2], shift),                   \
                           window(texels[2], texels[3], shift));                                                       \
        if (!kWholeQuads) keepTerms(values, kTerms - 4 * (quad));                                                      \
        sum.a += (weight) * values.a;                                                                                  \
        sum.b += (weight) * values.b;                                                                                  \
        sum.c += (weight) * values.c;                                                                                  \
    }

// Returns the weight of a layer where the surface has this paint and base color.
vec3 layerWeight(ViewLayer layer, vec4 paint, vec3 base) {
    vec3 weight = vec3(layer.weight);
    if (kLook == kSurfaceLook) {
        if (layer.channel >= 0) weight *= paint[layer.channel];
        if (layer.isTextured != 0) weight *= base;
    }
    return weight;
}

// Returns the weights of the first four materials.
vec4 paintWeights(Footprint at, vec4 color) {
    if (push.paint == kUnpainted) return vec4(0);
    vec4 paint = push.paint == kPaintedByMap ? textureOver(materialMap, at) : color;
    for (uint m = push.materials; m < 4; m++) paint[m] = 0;
    const float sum = paint.x + paint.y + paint.z + paint.w;
    return sum > 0 ? paint / sum : vec4(1, 0, 0, 0);
}

// The place of a normal's unshadowed tuple.
struct TuplePlace {
    vec2 polar;  // about +Y, in [0, 1]
    uint isBelow; // 1: the turn is relative to lowerTangentFrame()
    float turn; // rotation of the frame against that of the normal, in turns; 0 without tangents
};

Quad mixed(Quad a, Quad b, float share) {
    return Quad(mix(a.a, b.a, share), mix(a.b, b.b, share), mix(a.c, b.c, share));
}

Quad tupleAt(float azimuth, float row, uint rows, uint band, uint image) {
    const vec2 place = placeInBand(unshadowedTuples, azimuth, row, rows, band);
    return Quad(textureLod(unshadowedTuples, vec3(place, image), 0),
                textureLod(unshadowedTuples, vec3(place, image + 1), 0),
                textureLod(unshadowedTuples, vec3(place, image + 2), 0));
}

// Returns four terms of the unshadowed tuple of the whole light (`lit` 0) or its fill (1), interpolated between
// normals and turns.
Quad unshadowedTuple(TuplePlace at, uint quad, uint lit) {
    const uint image = lit * uint(textureSize(unshadowedTuples, 0).z) / kLightParts + push.firstTuples + 3 * quad;
    const float ring = at.polar.y * kTupleRings;
    // Between the center of the last ring and a pole, the opposite normals of that ring take part. Without tangents
    // frames differ around -Y.
    const float beyond = max(0.5 - ring, kTangents ? ring - (float(kTupleRings) - 0.5) : 0);
    const float opposite = fract(at.polar.x + 0.5);
    if (!kTangents) {
        const Quad own = tupleAt(at.polar.x, ring, kTupleRings, 0, image);
        return beyond > 0 ? mixed(own, tupleAt(opposite, ring, kTupleRings, 0, image), beyond) : own;
    }
    const float turn = fract(at.turn) * kTupleTurns, row = ring - at.isBelow * (kTupleRings - kTupleSideRings);
    const uint first = at.isBelow * kTupleTurns;
    Quad ofTurn[2];
    for (uint i = 0; i < 2; i++) {
        const uint band = first + (uint(turn) + i) % kTupleTurns;
        ofTurn[i] = tupleAt(at.polar.x, row, kTupleSideRings, band, image);
        if (beyond > 0)
            ofTurn[i] = mixed(ofTurn[i], tupleAt(opposite, row, kTupleSideRings, band, image), beyond);
    }
    return mixed(ofTurn[0], ofTurn[1], fract(turn));
}

// The unshadowed radiance of the whole light and of its parts.
struct Unshadowed {
    vec3 whole, fill, key;
};

// Returns the unshadowed radiance towards the eye, whose direction in the frame is `local`; or, if `isLimit`, the
// most to which normal maps may raise it.
Unshadowed unshadowedAt(vec3 direction, mat3 frame, vec3 local, vec4 paint, vec3 base, bool isLimit) {
    const vec3 mirror = vec3(-local.xy, local.z) * frame;
    const SpherePlaces at = spherePlaces(normalize(-direction), frame, mirror, kHarmonics > 0);
    Unshadowed sum = Unshadowed(vec3(0), vec3(0), vec3(0));
    if (kLook == kSingleLook) {
        sum.whole = push.weight * unshadowedRadiance(push.firstSlot, kHarmonics, at);
        if (kEstimate != kUnshadowed)
            sum.fill = push.weight * unshadowedRadiance(push.firstSlot + push.fillSlots, kHarmonics, at);
    } else
        for (uint i = 0; i < push.layers; i++) {
            const vec3 weight = (isLimit ? layers[i].mostOfFlat : 1) * layerWeight(layers[i], paint, base);
            const uint slot = layers[i].firstSlot, harmonics = min(layers[i].harmonics, kHarmonics);
            sum.whole += weight * unshadowedRadiance(slot, harmonics, at);
            if (kEstimate != kUnshadowed)
                sum.fill += weight * unshadowedRadiance(slot + push.fillSlots, harmonics, at);
        }
    sum.key = max(sum.whole - sum.fill, 0);
    return sum;
}

// The sums of a light that an estimate needs: with the K terms (view maps times tuples), and of tuples alone; `direct`
// and `directLit` are the direct light in `shadowed` and `lit`, if kTellsDirect.
struct Sums {
    Quad shadowed, terms, lit, unlit, direct, directLit;
};

const Quad kNone = Quad(vec4(0), vec4(0), vec4(0));

Quad times(Quad a, Quad b) { return Quad(a.a * b.a, a.b * b.b, a.c * b.c); }
Quad plus(Quad a, Quad b) { return Quad(a.a + b.a, a.b + b.b, a.c + b.c); }
Quad minus(Quad a, Quad b) { return Quad(a.a - b.a, a.b - b.b, a.c - b.c); }

void addTerms(inout Sums sums, Quad maps, Quad weights, Quad tuple, Quad direct, Quad free) {
    if (kTellsDirect) {
        sums.direct = plus(sums.direct, times(maps, direct));
        sums.directLit = plus(sums.directLit, times(weights, direct));
    }
    sums.shadowed = plus(sums.shadowed, times(maps, tuple));
    sums.terms = plus(sums.terms, times(maps, free));
    sums.lit = plus(sums.lit, times(weights, tuple));
    sums.unlit = plus(sums.unlit, times(weights, free));
}

// Returns the weight of the sums of view maps.
float viewWeight() { return kLook == kSingleLook ? push.weight : 1; }

// Returns the estimate from the sums of a light and its unshadowed radiance.
vec3 estimateOf(Sums sums, vec3 exact, vec3 leastView) {
    const float weight = viewWeight();
    const bool isBounced = (kEstimate & kBounced) != 0;
    const vec3 shadowed = weight * sumOf(sums.shadowed), terms = weight * sumOf(sums.terms);
    const vec3 lit = sumOf(sums.lit), unlit = sumOf(sums.unlit);
    if ((kEstimate & kResidualRatio) != 0) {
        const vec3 direct = kTellsDirect ? weight * sumOf(sums.direct) : shadowed,
                   directLit = kTellsDirect ? sumOf(sums.directLit) : lit;
        return ratioEstimate(shadowed, direct, directLit, exact, terms, unlit, isBounced, leastView);
    }
    return differenceEstimate(shadowed, litShare(lit, unlit), exact, terms, isBounced);
}

// Returns the radiance, which is never negative; and, for the residual or a shadow, what it would be if nothing cast
// shadows.
vec3 shade(uint triangle, vec3 direction, out vec3 unshadowed) {
    unshadowed = vec3(0);
    const uvec3 corners = texelOf(triangles, int(triangle)).xyz;
    vec4 low[3], high[3];
    for (int c = 0; c < 3; c++) {
        low[c] = texelOf(vertices, int(corners[c] * kVertexTexels));
        high[c] = texelOf(vertices, int(corners[c] * kVertexTexels + 1));
    }
    // Weights that rounding puts outside are moved to the nearest edge.
    vec3 weights = barycentricWeights(push.rays.eye, direction, vec3[3](low[0].xyz, low[1].xyz, low[2].xyz));
    weights.yz = clamp(weights.yz, 0, 1);
    weights.yz /= max(1, weights.y + weights.z);
    weights.x = 1 - weights.y - weights.z;

    vec3 normal = vec3(0);
    for (int c = 0; c < 3; c++) normal += weights[c] * vec3(low[c].w, high[c].xy);
    // Opposite normals can cancel out on a fold, where any direction will do.
    normal = dot(normal, normal) < 1e-12 ? vec3(0, 1, 0) : normalize(normal);
    mat3 frame = tangentFrame(normal);
    vec3 tangent = vec3(0);
    TuplePlace tuplePlace = TuplePlace(vec2(0), uint(normal.y < 0), 0);
    if (kTangents) {
        for (int c = 0; c < 3; c++)
            tangent += weights[c] * texelOf(vertices, int(corners[c] * kVertexTexels + 3)).xyz;
        const mat3 own = tangentFrame(normal, tangent);
        const vec3 turned = (normal.y < 0 ? lowerTangentFrame(normal) : frame) * (vec3(1, 0, 0) * own);
        tuplePlace.turn = atan(turned.y, turned.x) / kTurn;
        frame = own;
    }
    const vec3 local = liftAboveHorizon(frame * normalize(-direction));
    const vec2 place = diskMapCoordinates(push.mapping, local);

    vec4 paint = vec4(0);
    vec3 base = vec3(0), emitted = vec3(0);
    mat3 mapped = frame; // frame of the mapped normal; transport is in that of the vertices
    vec3 seen = local;
    if (kLook == kSurfaceLook) {
        const vec3 corner[3] = vec3[3](low[0].xyz, low[1].xyz, low[2].xyz);
        const vec3 toRight = barycentricSlopes(push.rays.eye, direction, corner, push.rays.right, weights);
        const vec3 toBelow = barycentricSlopes(push.rays.eye, direction, corner, push.rays.down, weights);
        Footprint at = Footprint(vec2(0), vec2(0), vec2(0));
        vec4 color = vec4(0);
        for (int c = 0; c < 3; c++) {
            at.uv += weights[c] * high[c].zw;
            at.right += toRight[c] * high[c].zw;
            at.down += toBelow[c] * high[c].zw;
            color += weights[c] * texelOf(vertices, int(corners[c] * kVertexTexels + 2));
        }
        paint = paintWeights(at, color);
        base = textureOver(baseColor, at).rgb;
        if (detail.isTinted != 0) base *= color.rgb;
        emitted = detail.emission * textureOver(emissionMap, at).rgb;
        if (detail.normalScale != 0) {
            const vec3 map = 2 * textureOver(normalMap, at).xyz - 1;
            vec3 found = mappedNormal(normal, corner,
                                            vec2[3](high[0].zw, high[1].zw, high[2].zw),
                                            map * vec3(detail.normalScale, detail.normalScale, 1));
            found = facingNormal(found, normalize(-direction));
            mapped = kTangents ? tangentFrame(found, tangent) : tangentFrame(found);
            seen = liftAboveHorizon(mapped * normalize(-direction));
        }
    }
    Unshadowed exact = Unshadowed(vec3(0), vec3(0), vec3(0));
    tuplePlace.polar = polarPlace(vec3(0, 1, 0), vec3(1, 0, 0), normal).yx;
    // At -Y tangentFrame() is singular, and equals the frames at this azimuth.
    if (!kTangents && normal.y < -1 + 1e-5) tuplePlace.polar.x = 0.25;
    if (kEstimate != kTermsAlone) {
        // Mapped normals may face light below the surface's horizon, for which there is no visibility. They raise the
        // radiance at most by the concentration of its kernel, which is too little if a low sun is the only light.
        exact = unshadowedAt(direction, mapped, seen, paint, base, false);
        if (kLook == kSurfaceLook && detail.normalScale != 0) {
            const Unshadowed most = unshadowedAt(direction, frame, local, paint, base, true);
            exact = Unshadowed(min(exact.whole, most.whole), min(exact.fill, most.fill), min(exact.key, most.key));
        }
        unshadowed = exact.whole;
        if (kEstimate == kUnshadowed) return exact.whole + emitted;
    }

    Sums whole = Sums(kNone, kNone, kNone, kNone, kNone, kNone), fill = whole;
    Quad views = kNone;
    const uint quads = kAllTerms ? kQuads : (push.terms + 3) / 4;
    for (uint quad = 0; quad < quads; quad++) {
        Quad maps = kNone;
        if (kLook == kSingleLook)
            maps = mapsOf(place, push.firstMap, quad);
        else
            for (uint i = 0; i < push.layers; i++) {
                const vec3 weight = layerWeight(layers[i], paint, base);
                const Quad layer = mapsOf(place, layers[i].firstMap, quad);
                maps = plus(maps, Quad(weight.rgbr * layer.a, weight.gbrg * layer.b, weight.brgb * layer.c));
            }
        if (!kAllTerms) keepTerms(maps, push.terms - 4 * quad);
        views = plus(views, maps);
        Quad tuple = kNone, fillTuple = kNone, direct = kNone, fillDirect = kNone;
        for (int c = 0; c < 3; c++) {
            Quad own = kNone, fillOwn = kNone;
            ADD_TUPLE(own, weights[c], tuples, corners[c], quad)
            tuple = plus(tuple, own);
            if (kEstimate == kTermsAlone) continue;
            ADD_TUPLE(fillOwn, weights[c], fillTuples, corners[c], quad)
            fillTuple = plus(fillTuple, fillOwn);
            if (!kTellsDirect) continue;
            const vec4 share = unpackUnorm4x8(texelOf(directShares, int(corners[c] * kQuads + quad)).x);
            const Quad shares = Quad(share.xxxy, share.yyzz, share.zwww);
            direct = plus(direct, times(shares, own));
            fillDirect = plus(fillDirect, times(shares, fillOwn));
        }
        Quad irradiance = Quad(vec4(1), vec4(1), vec4(1));
        if ((kEstimate & kResidualDifference) != 0) {
            const int first = int(push.firstTuples + 3 * quad);
            irradiance = Quad(texelOf(irradianceWeights, first), texelOf(irradianceWeights, first + 1),
                              texelOf(irradianceWeights, first + 2));
        }
        if (!kAllTerms) keepTerms(irradiance, push.terms - 4 * quad);
        const Quad free = kDrawn != kTermsAlone ? unshadowedTuple(tuplePlace, quad, 0) : kNone;
        addTerms(whole, maps, irradiance, tuple, direct, free);
        if (kEstimate != kTermsAlone)
            addTerms(fill, maps, irradiance, fillTuple, fillDirect, unshadowedTuple(tuplePlace, quad, 1));
    }
    if (kEstimate == kTermsAlone) {
        unshadowed = viewWeight() * sumOf(whole.terms);
        // A truncated sum of products can be negative.
        return max(viewWeight() * sumOf(whole.shadowed), 0) + emitted;
    }
    const Sums key = Sums(minus(whole.shadowed, fill.shadowed), minus(whole.terms, fill.terms),
                          minus(whole.lit, fill.lit), minus(whole.unlit, fill.unlit),
                          minus(whole.direct, fill.direct), minus(whole.directLit, fill.directLit));
    // Spheres are blurred: they show some of the key to normals that face away from it.
    if (luminance(sumOf(key.unlit)) <= 0) exact.key = vec3(0);
    const vec3 mean = viewWeight() / float(kAllTerms ? kTerms : push.terms) * sumOf(views);
    return estimateOf(fill, exact.fill, vec3(kLeastView)) +
           estimateOf(key, exact.key, kLeastView + mean) + emitted;
}

// Returns the ground's coverage where the pixel's ray meets a triangle's plane. C++ twin: groundCoverage() in
// engine/render/ground_fade.h.
float groundCoverage(uint triangle, vec3 direction) {
    if (push.groundFade.w == 0) return 1;
    const uvec3 corners = texelOf(triangles, int(triangle)).xyz;
    vec3 place[3];
    for (int c = 0; c < 3; c++) place[c] = texelOf(vertices, int(corners[c] * kVertexTexels)).xyz;
    const vec3 normal = cross(place[1] - place[0], place[2] - place[0]);
    const float depth = dot(place[0] - push.rays.eye, normal) / dot(direction, normal);
    const float away = distance((push.rays.eye + depth * direction).xz, push.groundFade.xy);
    const float share = 1 - smoothstep(push.groundFade.z, push.groundFade.w, away);
    return share * share;
}

// Returns the alpha of a ground's shadow. C++ twin: shadowAlpha() in engine/render/ground_fade.h.
float shadowAlpha(vec3 radiance, vec3 unshadowed) {
    return max(1 - litShare(radiance, unshadowed) - kLeastShadow, 0) / (1 - kLeastShadow);
}

// Returns the radiance where the ray through a point of the image meets the triangle, premultiplied by coverage.
vec4 shadeAt(uint triangle, vec2 place) {
    const vec3 direction = push.rays.corner + place.x * push.rays.right + place.y * push.rays.down;
    const float coverage = groundCoverage(triangle, direction);
    if (!(coverage > 0)) return vec4(0);
    vec3 unshadowed;
    const vec3 seen = shade(triangle, direction, unshadowed);
    return coverage * (kShowsShadow ? vec4(vec3(0), shadowAlpha(seen, unshadowed)) : vec4(seen, 1));
}

bool isOfPart(uint triangleId) { return triangleId - push.firstTriangleId < push.triangleCount; }

#ifdef MULTISAMPLED

// Sums the part's groups of samples, each times its share of the pixel. A group is the first sample left, with all
// whose triangles share a vertex with its own; all samples of an inner pixel are one.
void main() {
    uint seen[kSamples], left = 0;
    uvec3 corners[kSamples];
    for (int i = 0; i < (kEdges ? kSamples : 1); i++) {
        seen[i] = texelFetch(triangleIds, ivec3(gl_FragCoord.xy, 0), i).x;
        const bool isOwn = isOfPart(seen[i]);
        if (kEdges) corners[i] = texelOf(triangles, isOwn ? int(seen[i] - push.firstTriangleId) : 0).xyz;
        left |= uint(isOwn) << i;
    }
    if (left == 0) discard;
    radiance = vec4(0);
    // One loop serves inner pixels and edges: drivers take twice as long to compile two calls of shadeAt().
    do {
        const uint first = findLSB(left);
        SampleGroup group = SampleGroup(left, vec2(0.5), 1);
        if (kEdges) {
            uint members = 0;
            for (uint i = 0; i < kSamples; i++) members |= uint(shareVertex(corners[first], corners[i])) << i;
            group = groupOf(members & left);
        }
        radiance += group.share * shadeAt(seen[first] - push.firstTriangleId, floor(gl_FragCoord.xy) + group.position);
        left &= ~group.members;
    } while (kEdges && left != 0);
}

#else

void main() {
    const uint triangleId = texelFetch(triangleIds, ivec3(gl_FragCoord.xy, 0), 0).x;
    // The stencil rejects most pixels of other parts before the shader runs.
    if (!isOfPart(triangleId)) discard;
    radiance = shadeAt(triangleId - push.firstTriangleId, gl_FragCoord.xy);
}

#endif
