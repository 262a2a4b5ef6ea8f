// The view pass's twin on the host, against which tests hold images of two parts.
#pragma once

#include "engine/math/tangent_frame.h"
#include "engine/render/view_pass.h"
#include "precompute/twins/relight_twin.h"
#include "precompute/twins/transport_twin.h"
#include "precompute/visibility/ray_tracer.h"
#include "tests/support/test_device.h"

#include <algorithm>
#include <array>
#include <bit>

namespace relume::test {

struct HostPixel {
    bool covered;
    bool steady; // away from edges and grazing angles, where rounding decides
    vec3 radiance;
};

// Finds the radiance in a direction from the eye by ray tracing and the definitions in docs/method.md.
class HostView {
  public:
    HostView(const vk::Device& device, const Asset& asset, const LightVector& light,
             const Appearance& appearance)
        : mAsset(asset), mAppearance(appearance), mEdgeWeight(roundsFinely(device) ? 0.02f : 0.16f),
          mTracer(std::array{&asset.parts[0].mesh, &asset.parts[1].mesh}) {
        for (size_t i = 0; i < asset.parts.size(); i++)
            mTuples.push_back(relight(rowsOf(setOf(i).transport), light));
        for (const AssetPart& part : asset.parts)
            mTextures.push_back(
                {part.baseColor ? makeMipLevels(*part.baseColor) : std::vector<Texture>(),
                 part.materialMap ? makeMipLevels(*part.materialMap) : std::vector<Texture>()});
    }

    // Returns what is seen at `place` of an image, in pixels from its upper left corner.
    HostPixel at(const Camera& camera, vec2 place, ivec2 size) const {
        const auto hit = mTracer.intersect(camera.eye, camera.directionAt(place, size.x, size.y));
        if (!hit) return {false, false, vec3(0)};
        return at(camera, place, size, *hit);
    }

    // Returns a pixel of several samples, grouped as the shaders do, and whether all its samples are steady.
    std::pair<vec4, bool> at(const Camera& camera, ivec2 pixel, ivec2 size, int samples) const {
        std::vector<std::optional<RayHit>> hits;
        std::vector<uint32_t> seen;
        bool isSteady = true;
        for (int i = 0; i < samples; i++) {
            const vec2 place = vec2(pixel) + samplePosition(samples, i);
            const vec3 ray = camera.directionAt(place, size.x, size.y);
            hits.push_back(mTracer.intersect(camera.eye, ray));
            const auto& hit = hits.back();
            isSteady = isSteady && hit && at(camera, place, size, *hit).steady;
            seen.push_back(hit ? (hit->mesh << 24 | hit->triangle) + 1 : 0);
        }
        const auto hitOf = [&](uint32_t surface) {
            return *hits[size_t(std::ranges::find(seen, surface) - seen.begin())];
        };
        const auto isOne = [&](uint32_t a, uint32_t b) {
            const RayHit first = hitOf(a), second = hitOf(b);
            if (first.mesh != second.mesh) return false;
            const std::vector<uvec3>& triangles = mAsset.parts[first.mesh].mesh.triangles;
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++)
                    if (triangles[first.triangle][i] == triangles[second.triangle][j]) return true;
            return false;
        };
        vec4 sum(0);
        for (const uint32_t members : groupSamples(seen, isOne)) {
            vec2 place(pixel);
            const auto count = float(std::popcount(members));
            for (int i = 0; i < samples; i++)
                if (members >> i & 1) place += samplePosition(samples, i) / count;
            RayHit hit = *hits[size_t(std::countr_zero(members))];
            const vec3 ray = camera.directionAt(place, size.x, size.y);
            hit.weights = weightsAt(hit, camera.eye, ray);
            sum += count / float(samples) * vec4(at(camera, place, size, hit).radiance, 1);
        }
        return {sum, isSteady};
    }

  private:
    // Returns the weights of the place where a ray meets the plane of the triangle that another ray has hit.
    vec3 planeWeightsAt(const RayHit& hit, vec3 eye, vec3 direction) const {
        const Mesh& mesh = mAsset.parts[hit.mesh].mesh;
        const uvec3 corners = mesh.triangles[hit.triangle];
        const vec3 origin = mesh.positions[corners.x];
        const mat3 axes(mesh.positions[corners.y] - origin, mesh.positions[corners.z] - origin, -direction);
        const vec3 solved = glm::inverse(axes) * (eye - origin);
        return {1 - solved.x - solved.y, vec2(solved)};
    }

    // Returns the same weights, moved to the triangle's nearest edge if they are outside.
    vec3 weightsAt(const RayHit& hit, vec3 eye, vec3 direction) const {
        const vec3 weights = planeWeightsAt(hit, eye, direction);
        vec2 yz = glm::clamp(vec2(weights.y, weights.z), 0.0f, 1.0f);
        yz /= std::max(1.0f, yz.x + yz.y);
        return {1 - yz.x - yz.y, yz};
    }

    // Returns the change of the texture coordinates towards the pixel that is `next` away.
    vec2 uvStep(const Camera& camera, vec2 place, ivec2 size, const RayHit& hit, vec2 next) const {
        const Mesh& mesh = mAsset.parts[hit.mesh].mesh;
        if (mesh.uvs.empty()) return vec2(0);
        constexpr float kShare = 0.05f;
        const auto weights = [&](float share) {
            return planeWeightsAt(hit, camera.eye, camera.directionAt(place + share * next, size.x, size.y));
        };
        const vec3 change = (weights(kShare) - weights(-kShare)) / (2 * kShare);
        vec2 step(0);
        for (int c = 0; c < 3; c++) step += change[c] * mesh.uvs[mesh.triangles[hit.triangle][c]];
        return step;
    }

    // Returns the pixel at `place`, where the surface `seen` is seen.
    HostPixel at(const Camera& camera, vec2 place, ivec2 size, const RayHit& seen) const {
        const vec3 direction = camera.directionAt(place, size.x, size.y);
        const RayHit* const hit = &seen;
        const AssetPart& part = mAsset.parts[hit->mesh];
        const uvec3 corners = part.mesh.triangles[hit->triangle];
        vec3 normal(0), tangent(0);
        vec2 uv(0);
        vec4 color(0);
        for (int c = 0; c < 3; c++) {
            normal += hit->weights[c] * part.mesh.normals[corners[c]];
            if (!part.mesh.tangents.empty()) tangent += hit->weights[c] * part.mesh.tangents[corners[c]];
            if (!part.mesh.uvs.empty()) uv += hit->weights[c] * part.mesh.uvs[corners[c]];
            if (!part.mesh.colors.empty()) color += hit->weights[c] * part.mesh.colors[corners[c]];
        }
        const vec3 toEye = tangentFrame(glm::normalize(normal), tangent).toLocal(glm::normalize(-direction));
        const vec3 local = liftAboveHorizon(toEye);
        const FactoredBrdf& brdf = setOf(hit->mesh).brdf;
        const vec2 right = uvStep(camera, place, size, *hit, {1, 0}),
                   down = uvStep(camera, place, size, *hit, {0, 1});
        const auto look = [&](const std::vector<Texture>& levels) {
            return levels.empty() ? std::optional<vec4>() : sampleFootprint(levels, uv, right, down);
        };
        const std::vector<vec3> weights = layerWeights(hit->mesh, look(mTextures[hit->mesh].baseColor),
                                                       look(mTextures[hit->mesh].materialMap), color);
        vec3 radiance(0);
        for (int term = 0; term < brdf.terms; term++) {
            vec3 tuple(0);
            for (int c = 0; c < 3; c++) tuple += hit->weights[c] * tupleOf(hit->mesh, corners[c], term);
            for (int layer = 0; layer < brdf.layers; layer++)
                radiance += weights[size_t(layer)] * tuple *
                            lookupMap(brdf.viewMap(layer, term), brdf.size, brdf.mapping, local);
        }
        const float inside = std::min({hit->weights.x, hit->weights.y, hit->weights.z});
        return {true, inside > mEdgeWeight && toEye.z > 0.15f, glm::max(radiance, vec3(0))};
    }

    const MaterialSet& setOf(size_t part) const { return mAsset.parts[part].sets[mAppearance[part].set]; }

    // Returns the weight of every layer of the bound set, from the definitions in appearance.h.
    std::vector<vec3> layerWeights(size_t index, std::optional<vec4> baseColor, std::optional<vec4> map,
                                   vec4 color) const {
        const MaterialSet& set = setOf(index);
        const PartAppearance& bound = mAppearance[index];
        vec4 paint = map.value_or(color);
        float sum = 0;
        for (size_t m = 0; m < std::min<size_t>(set.materials.size(), 4); m++) sum += paint[int(m)];
        const vec3 base(baseColor.value_or(vec4(1)));
        std::vector<vec3> weights(size_t(set.brdf.layers), vec3(0));
        for (size_t m = 0; m < set.materials.size(); m++) {
            const AssetMaterial& material = set.materials[m];
            const float painted = sum > 0 ? paint[int(m)] / sum : float(m == 0);
            const float weight = bound.painted ? painted : bound.weights[m];
            weights[size_t(material.layer)] = vec3(weight);
            if (material.hasBase) weights[size_t(material.layer) + 1] = weight * base;
        }
        return weights;
    }

    vec3 tupleOf(size_t part, uint32_t vertex, int term) const {
        const SparseTransport& transport = rowsOf(setOf(part).transport);
        const size_t row = size_t(vertex) * transport.terms + size_t(term);
        return mTuples[part][row];
    }

    const Asset& mAsset;
    const Appearance& mAppearance;
    float mEdgeWeight; // barycentric weight up to which a pixel is too near an edge to be steady
    RayTracer mTracer;
    std::vector<std::vector<vec3>> mTuples;
    struct Textures {
        std::vector<Texture> baseColor, materialMap; // mip levels; empty for none
    };
    std::vector<Textures> mTextures; // of the parts
};

} // namespace relume::test
