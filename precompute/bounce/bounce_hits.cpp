#include "precompute/bounce/bounce_hits.h"

#include "engine/math/hashed_numbers.h"
#include "engine/math/tangent_frame.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

// The rays along which a vertex gathers bounced light: cosine-distributed directions in its frame, kSide²
// strata of a square, mapped to the hemisphere and shifted differently for every vertex.
class BounceRays {
  public:
    static constexpr int kSide = 32;
    static_assert(kSide * kSide == BounceHits::kRays);
    static constexpr float kWeight = kPi / (kSide * kSide); // cosine · solid angle that a ray stands for

    BounceRays(size_t part, uint32_t vertex) {
        HashedNumbers random(vertex, uint32_t(part));
        for (int axis = 0; axis < 3; axis++) mShift[axis] = random.next();
    }

    // Advances to the next ray; must be called before the first. Returns false after the last.
    bool next() { return ++mRay < kSide * kSide; }

    // Returns a unit vector in the frame.
    vec3 direction() const {
        const float u = (float(mRay / kSide) + mShift.x) / kSide,
                    v = (float(mRay % kSide) + mShift.y) / kSide;
        const float radius = std::sqrt(u), angle = 2 * kPi * v;
        return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(std::max(0.0f, 1 - u))};
    }

    // Returns a number in [0, 1), independent of the direction, for a random choice per ray.
    float choice() const {
        constexpr double kGoldenRatio = 0.6180339887498949; // its multiples are evenly distributed
        const double place = double(mShift.z) + mRay * kGoldenRatio;
        return float(place - std::floor(place));
    }

  private:
    int mRay = -1;
    vec3 mShift; // of the square's axes, and of choice()
};

std::vector<const Mesh*> meshesOf(const Asset& asset) {
    std::vector<const Mesh*> meshes;
    for (const AssetPart& part : asset.parts) meshes.push_back(&part.mesh);
    return meshes;
}

} // namespace

vec3 reflectedShare(const FactoredBrdf& brdf, int layer) {
    // (1 / π) ∫∫ f cosθi cosθo dωi dωo, where the integrals of each term separate.
    std::vector<vec3> in(size_t(brdf.terms), vec3(0)), out = in;
    for (BounceRays rays(0, 0); rays.next();) {
        const MapPlace place = placeInMap(brdf.size, brdf.mapping, rays.direction());
        for (int term = 0; term < brdf.terms; term++) {
            in[size_t(term)] += BounceRays::kWeight * lookupMap(brdf.lightMap(term), place);
            out[size_t(term)] += BounceRays::kWeight * lookupMap(brdf.viewMap(layer, term), place);
        }
    }
    vec3 share(0);
    for (size_t term = 0; term < in.size(); term++) share += in[term] * out[term] / kPi;
    return share;
}

vec3 sourceGain(vec3 reflectedShare) {
    constexpr float kTolerance = 1e-3f; // of sums over directions
    vec3 gain(1);
    for (int channel = 0; channel < 3; channel++)
        if (reflectedShare[channel] > 1 + kTolerance) gain[channel] = 1 / reflectedShare[channel];
    return gain;
}

std::vector<std::vector<vec3>> sourceGains(const Asset& asset, const Appearance& bound) {
    std::vector<std::vector<vec3>> gains;
    for (size_t part = 0; part < asset.parts.size(); part++) {
        gains.emplace_back();
        for (const BoundLayer& shown : boundLayers(asset.parts[part], bound[part]))
            gains.back().push_back(
                sourceGain(reflectedShare(asset.parts[part].sets[bound[part].set].brdf, shown.layer)));
    }
    return gains;
}

BounceHits::BounceHits(const Asset& asset, const Appearance& bound)
    : mAsset(asset), mBound(bound), mGains(sourceGains(asset, bound)), mTracer(meshesOf(asset)) {
    for (size_t part = 0; part < asset.parts.size(); part++) {
        mLayers.push_back(boundLayers(asset.parts[part], bound[part]));
        for (size_t i = 0; i < mLayers[part].size(); i++) {
            const vec3 gain = mGains[part][i];
            if (gain != vec3(1))
                mHeld.push_back({part, mLayers[part][i].layer, 1 / std::min({gain.x, gain.y, gain.z})});
        }
    }
}

// Attributes are interpolated as in the view pass. Rows are those of one corner, chosen with its weight as
// probability.
bool BounceHits::find(vec3 origin, vec3 direction, float choice, BounceHit& hit) const {
    const std::optional<RayHit> met = mTracer.intersect(origin, direction);
    if (!met || !meetsFront(mAsset.parts[met->mesh].mesh, *met, direction)) return false;
    const AssetPart& part = mAsset.parts[met->mesh];
    const Mesh& mesh = part.mesh;
    const uvec3 corners = mesh.triangles[met->triangle];
    const vec3 weights = met->weights;
    const auto interpolate = [&](const auto& values) {
        return weights.x * values[corners.x] + weights.y * values[corners.y] + weights.z * values[corners.z];
    };
    const vec3 normal = interpolate(mesh.normals);
    if (glm::dot(normal, normal) < 1e-12f) return false; // normals cancel on a fold
    const vec3 tangent = mesh.tangents.empty() ? vec3(0) : interpolate(mesh.tangents);
    const TangentFrame frame = tangentFrame(glm::normalize(normal), tangent);
    const vec3 outgoing = liftAboveHorizon(frame.toLocal(-direction));
    const vec2 uv = mesh.uvs.empty() ? vec2(0) : interpolate(mesh.uvs);
    const vec4 color = mesh.colors.empty() ? vec4(0) : interpolate(mesh.colors);

    hit.part = met->mesh;
    hit.vertex = choice < weights.x ? corners.x : choice < weights.x + weights.y ? corners.y : corners.z;
    const size_t set = mBound[hit.part].set;
    const FactoredBrdf& brdf = part.sets[set].brdf;
    const std::vector<BoundLayer>& layers = mLayers[hit.part];
    const std::vector<vec3> shares = layerWeights(part, set, layers, uv, color);
    const MapPlace place = placeInMap(brdf.size, brdf.mapping, outgoing);
    for (int term = 0; term < brdf.terms; term++) {
        vec3 view(0);
        for (size_t i = 0; i < layers.size(); i++)
            view += shares[i] * mGains[hit.part][i] * lookupMap(brdf.viewMap(layers[i].layer, term), place);
        hit.views[size_t(term)] = view;
    }
    return true;
}

void BounceHits::find(size_t part, uint32_t vertex, const std::function<void(const BounceHit&)>& take) const {
    const Mesh& mesh = mAsset.parts[part].mesh;
    const TangentFrame frame = frameOf(mesh, vertex);
    const vec3 origin = mesh.positions[vertex] + mAsset.visibilityOffset * mesh.normals[vertex];
    BounceHit hit;
    for (BounceRays rays(part, vertex); rays.next();) {
        hit.direction = rays.direction();
        if (find(origin, frame.toWorld(hit.direction), rays.choice(), hit)) take(hit);
    }
}

void BounceHits::lookupLight(size_t part, vec3 direction, std::span<vec3> light) const {
    size_t row = 0;
    for (const MaterialSet& set : mAsset.parts[part].sets) {
        const MapPlace place = placeInMap(set.brdf.size, set.brdf.mapping, direction);
        for (int term = 0; term < set.brdf.terms; term++)
            light[row++] = lookupMap(set.brdf.lightMap(term), place) * BounceRays::kWeight;
    }
}

} // namespace relume
