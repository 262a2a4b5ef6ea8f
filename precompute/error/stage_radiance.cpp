#include "precompute/error/stage_radiance.h"

#include "engine/base/check.h"
#include "engine/math/haar.h"
#include "engine/transport/asset_check.h"
#include "precompute/bake/baked_options.h"
#include "precompute/error/shared_progress.h"
#include "precompute/reference/path_sampling.h"
#include "precompute/reference/reference_image.h"
#include "precompute/reference/vertex_views.h"
#include "precompute/transport/row_packing.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

std::vector<vec3> haarOf(std::vector<vec3> cube, int faceSize) {
    haarForwardFaces(cube, faceSize);
    return cube;
}

vec3 product(std::span<const vec3> a, std::span<const vec3> b) {
    glm::dvec3 sum(0);
    for (size_t i = 0; i < a.size(); i++) sum += glm::dvec3(a[i] * b[i]);
    return vec3(sum);
}

vec3 productOf(std::span<const vec3> coefficients, std::span<const uint16_t> kept,
               std::span<const vec3> light) {
    glm::dvec3 sum(0);
    for (const uint16_t index : kept) sum += glm::dvec3(coefficients[index] * light[index]);
    return vec3(sum);
}

uint64_t vertexKey(size_t part, uint32_t vertex) { return uint64_t(part) << 32 | vertex; }

} // namespace

// The whole light or its fill, in the orders and bases that stages need.
struct StageTracer::DrawnPart {
    std::vector<vec3> drawn;  // 6 F² Haar coefficients, of the LightVector
    std::vector<vec3> haar;   // all 6 F² Haar coefficients
    std::vector<vec3> coarse; // 6 F² texels in row order
};

// A light, and what stages need of it.
struct StageTracer::Light {
    std::array<DrawnPart, kLightParts> parts; // by LightPart
    std::vector<vec3> coarseOf;               // per cell of mTruth: the coarse texel around it
    std::vector<vec3> fine;                   // per cell of mTruth
    LightDistribution paths;                  // of `fine`, for paths
};

// A vertex's tuples at the stages that depend on them.
struct StageTracer::Tuples {
    static constexpr size_t kStages = 4;  // as drawn, whole light, exact storage, all coefficients
    static constexpr size_t kBounced = 4; // the bounced part of the last stage
    static constexpr size_t kValues = 5;
    std::vector<vec3> values; // [((light · kLightParts + lit) · kValues + stage) · K + term]

    static size_t first(size_t light, LightPart lit, size_t stage, size_t terms) {
        return ((light * kLightParts + size_t(lit)) * kValues + stage) * terms;
    }
    std::span<const vec3> at(size_t light, LightPart lit, size_t stage, size_t terms) const {
        return std::span(values).subspan(first(light, lit, stage, terms), terms);
    }
};

// The materials bound at a point of a part, seen from the eye.
struct StageTracer::Binding {
    const FactoredBrdf* brdf;
    std::vector<BoundLayer> layers;
    std::vector<vec3> weights;   // of the layers
    std::vector<vec3> views;     // per term: view maps times weights, summed
    const ResidualSet* residual; // null: terms alone
};

struct StageTracer::Vertices {
    std::map<uint64_t, Tuples> tuples; // by vertexKey()

    // Returns a point's tuple of a stage, interpolated between the corners of its triangle; with `directOf`,
    // the direct light in it by the shares of that set.
    std::vector<vec3> interpolate(const RayHit& hit, const uvec3& corners, size_t light, LightPart lit,
                                  size_t stage, size_t terms, const MaterialSet* directOf = nullptr) const {
        std::vector<vec3> tuple(terms, vec3(0));
        for (int corner = 0; corner < 3; corner++) {
            const std::span<const vec3> of =
                tuples.at(vertexKey(hit.mesh, corners[corner])).at(light, lit, stage, terms);
            for (size_t term = 0; term < terms; term++) {
                const float share = directOf ? directOf->directShare(corners[corner], term) : 1;
                tuple[term] += hit.weights[corner] * share * of[term];
            }
        }
        return tuple;
    }
};

StageTracer::StageTracer(const Asset& asset, const Appearance& appearance, const StageOptions& options,
                         const BakeOptions& baked)
    : mAsset(asset), mAppearance(appearance), mOptions(options),
      mBound(asset, appearance, ReferenceBrdf::Exact, mBrdfs), mBaked(asset), mTruth(kTruthFaceSize),
      mFull(mergedMesh(asset), asset.visibilitySize), mFullFine(mergedMesh(asset), kTruthVisibility),
      mFullOffset(kFullMeshShadowOffset * boundsOf(asset).radius()), mMeshes(partMeshes(asset)),
      mSurfaces(mMeshes) {
    RELUME_CHECK_EQ(options.bounced != nullptr, asset.bounces > 0);
    RELUME_CHECK(options.bounces >= asset.bounces && options.bounces <= kMostBounces);
    for (size_t part = 0; part < asset.parts.size(); part++)
        mTables.emplace_back(asset.parts[part].sets[appearance[part].set],
                             boundLayers(asset.parts[part], appearance[part]), baked.factorization.method,
                             mBrdfs);
}

StageTracer::StageTracer(const Asset& asset, const Appearance& appearance, const StageOptions& options)
    : StageTracer(asset, appearance, options, optionsOf(asset)) {}

StageTracer::Light StageTracer::prepare(const StageLight& light) const {
    Light prepared{.paths = LightDistribution(light.fine)};
    for (size_t lit = 0; lit < kLightParts; lit++) {
        const DrawnCube& from = light.drawn[lit];
        RELUME_CHECK_EQ(from.cube.size, mAsset.faceSize);
        prepared.parts[lit] = {dequantizedLight(from.entries), haarOf(from.cube.radiance, mAsset.faceSize),
                               from.cube.radiance};
    }
    const std::vector<vec3> ordered = mBaked.lighting().ordered(light.drawn[0].cube);
    const size_t cells = mTruth.count() / mBaked.lighting().count();
    prepared.coarseOf.reserve(mTruth.count());
    for (size_t i = 0; i < mTruth.count(); i++) prepared.coarseOf.push_back(ordered[i / cells]);
    prepared.fine = mTruth.ordered(light.fine);
    return prepared;
}

StageTracer::Tuples StageTracer::vertexTuples(size_t part, uint32_t vertex,
                                              std::span<const Light> lights) const {
    const MaterialSet& set = mAsset.parts[part].sets[mAppearance[part].set];
    const auto terms = size_t(set.brdf.terms);
    Tuples tuples{std::vector<vec3>(lights.size() * kLightParts * Tuples::kValues * terms)};
    mBaked.forEachTerm(part, vertex, set.brdf, [&](size_t term, const std::vector<vec3>& direct) {
        const size_t row = size_t(vertex) * terms + term;
        std::vector<vec3> bounced(direct.size(), vec3(0));
        if (mOptions.bounced)
            mOptions.bounced->addTo(bounced, part, mAppearance[part].set, row, mAsset.faceSize);
        std::vector<vec3> exact(direct.size());
        std::ranges::transform(direct, bounced, exact.begin(), std::plus());
        const std::vector<uint16_t> kept = indicesOfLargest(exact, rowEntries(mAsset, set));
        const std::vector<vec3> stored = dequantizedRow(set.transport, row, exact.size());
        for (size_t light = 0; light < lights.size(); light++)
            for (const LightPart lit : {LightPart::Whole, LightPart::Fill}) {
                const DrawnPart& from = lights[light].parts[size_t(lit)];
                vec3* of = &tuples.values[Tuples::first(light, lit, 0, terms) + term];
                of[0] = product(stored, from.drawn);
                of[terms] = product(stored, from.haar);
                of[2 * terms] = productOf(exact, kept, from.haar);
                of[3 * terms] = product(exact, from.haar);
                of[Tuples::kBounced * terms] = product(bounced, from.haar);
            }
    });
    return tuples;
}

StageTracer::Binding StageTracer::bindingAt(size_t number, const SurfacePoint& baked) const {
    const AssetPart& part = mAsset.parts[number];
    const MaterialSet& set = part.sets[mAppearance[number].set];
    const FactoredBrdf& brdf = set.brdf;
    const ResidualSet* residual = mOptions.addsResidual ? set.residual.get() : nullptr;
    Binding binding{&brdf, boundLayers(part, mAppearance[number]), baked.layerWeights(), {}, residual};
    binding.views = pointViews(brdf, binding.layers, binding.weights, baked.outgoing);
    return binding;
}

std::vector<UnshadowedLight> StageTracer::unshadowedAt(const SurfacePoint& point, const SurfacePoint& baked,
                                                       const SurfacePoint& limit, const Binding& binding,
                                                       std::span<const Light> lights) const {
    if (!binding.residual) return std::vector<UnshadowedLight>(lights.size() * kLightParts);
    std::vector<std::span<const vec3>> cubes;
    for (const Light& light : lights)
        for (const DrawnPart& part : light.parts) cubes.emplace_back(part.coarse);
    return sumUnshadowed(mBaked, point, baked, limit, *binding.brdf, cubes);
}

void StageTracer::traceVertices(const RayHit& hit, const Binding& binding,
                                std::span<const UnshadowedLight> unshadowed, const Vertices& vertices,
                                std::span<StageRadiance> result) const {
    const size_t terms = binding.views.size();
    const AssetPart& part = mAsset.parts[hit.mesh];
    const MaterialSet& set = part.sets[mAppearance[hit.mesh].set];
    const uvec3 corners = part.mesh.triangles[hit.triangle];
    constexpr size_t kFirst = size_t(ErrorSource::Drawing) + 1;
    for (size_t light = 0; light < result.size(); light++) {
        for (size_t stage = 0; stage < Tuples::kStages; stage++) {
            const auto tupleOf = [&](LightPart lit, const MaterialSet* directOf) {
                return vertices.interpolate(hit, corners, light, lit, stage, terms, directOf);
            };
            const std::vector<vec3> whole = tupleOf(LightPart::Whole, nullptr),
                                    fill = tupleOf(LightPart::Fill, nullptr),
                                    direct = tupleOf(LightPart::Whole, &set),
                                    directFill = tupleOf(LightPart::Fill, &set);
            result[light][kFirst + stage] = estimateRadiance(
                binding.residual, binding.views, {whole, direct, unshadowed[kLightParts * light]},
                {fill, directFill, unshadowed[kLightParts * light + 1]});
        }
        result[light][0] = result[light][kFirst];
    }
}

// Computes the point's own direct transport: with the K terms, the whole table, and the BRDF itself. Bounced
// light is still interpolated.
std::vector<vec3> StageTracer::traceOwnTransport(const RayHit& hit, const SurfacePoint& point,
                                                 const SurfacePoint& own, const Binding& binding,
                                                 std::span<const UnshadowedLight> unshadowed,
                                                 const Vertices& vertices, std::span<const uint64_t> baked,
                                                 std::span<const Light> lights,
                                                 std::span<StageRadiance> result) const {
    const FactoredBrdf& brdf = *binding.brdf;
    const std::vector<LitCell> lit = mBaked.lit(baked, own.frame),
                               seen = point.frame.n == own.frame.n ? lit : mBaked.lit(baked, point.frame);
    const std::vector<MapPlace> places = placesOf(lit, brdf.size, brdf.mapping),
                                seenPlaces = point.frame.n == own.frame.n
                                                 ? places
                                                 : placesOf(seen, brdf.size, brdf.mapping);
    const std::vector<vec3> table =
        mTables[hit.mesh].lightMap(binding.layers, binding.weights, point.outgoing);

    constexpr size_t kFirst = size_t(ErrorSource::Interpolation) + 1, kStages = 2;
    const size_t terms = binding.views.size();
    std::vector<glm::dvec3> tuples(lights.size() * kLightParts * terms);
    std::vector<std::array<glm::dvec3, kStages>> sums(lights.size());
    for (size_t i = 0; i < lit.size(); i++) {
        for (size_t term = 0; term < terms; term++) {
            const vec3 map = lit[i].weight * lookupMap(brdf.lightMap(int(term)), places[i]);
            for (size_t light = 0; light < lights.size(); light++)
                for (size_t part = 0; part < kLightParts; part++)
                    tuples[(light * kLightParts + part) * terms + term] +=
                        glm::dvec3(map * lights[light].parts[part].coarse[lit[i].texel]);
        }
    }
    for (size_t i = 0; i < seen.size(); i++) {
        const std::array<vec3, kStages> reflected = {lookupMap(table.data(), seenPlaces[i]),
                                                     point.reflected(seen[i].local)};
        for (size_t light = 0; light < lights.size(); light++)
            for (size_t stage = 0; stage < kStages; stage++)
                sums[light][stage] += glm::dvec3(seen[i].weight * reflected[stage] *
                                                 lights[light].parts[0].coarse[seen[i].texel]);
    }
    const AssetPart& owner = mAsset.parts[hit.mesh];
    const MaterialSet& set = owner.sets[mAppearance[hit.mesh].set];
    const uvec3 corners = owner.mesh.triangles[hit.triangle];
    const auto directShare = [&](size_t term) {
        if (set.directShares.empty()) return 1.0f; // exactly: then bounces add nothing
        float share = 0;
        for (int corner = 0; corner < 3; corner++)
            share += hit.weights[corner] * set.directShare(corners[corner], term);
        return share;
    };
    std::vector<vec3> added;
    for (size_t light = 0; light < lights.size(); light++) {
        std::array<std::vector<vec3>, kLightParts> byLit;
        for (size_t part = 0; part < kLightParts; part++) {
            const auto first = tuples.begin() + std::ptrdiff_t((light * kLightParts + part) * terms);
            byLit[part] = {first, first + std::ptrdiff_t(terms)};
        }
        std::array<std::vector<vec3>, kLightParts> directOf = byLit;
        const auto estimate = [&] {
            return estimateRadiance(binding.residual, binding.views,
                                    {byLit[0], directOf[0], unshadowed[kLightParts * light]},
                                    {byLit[1], directOf[1], unshadowed[kLightParts * light + 1]});
        };
        const vec3 direct = estimate();
        for (const LightPart part : {LightPart::Whole, LightPart::Fill}) {
            std::vector<vec3>& tuple = byLit[size_t(part)];
            const std::vector<vec3> bounced =
                vertices.interpolate(hit, corners, light, part, Tuples::kBounced, terms);
            std::ranges::transform(tuple, bounced, tuple.begin(), std::plus());
            for (size_t term = 0; term < terms; term++)
                directOf[size_t(part)][term] = directShare(term) * tuple[term];
        }
        result[light][kFirst] = estimate();
        added.push_back(result[light][kFirst] - direct);
        for (size_t stage = 0; stage < kStages; stage++)
            result[light][kFirst + 1 + stage] = glm::max(vec3(sums[light][stage]), vec3(0)) + added.back();
    }
    return added;
}

void StageTracer::traceTruth(const SurfacePoint& point, std::span<const uint64_t> baked,
                             std::span<const Light> lights, std::span<const vec3> bounced,
                             std::span<StageRadiance> result) const {
    std::vector<uint64_t> whole(mFull.texels() / 64), fine(mFullFine.texels() / 64);
    const vec3 origin = point.position + mFullOffset * point.normal;
    mFull.trace(origin, point.normal, whole);
    mFullFine.trace(origin, point.normal, fine);

    // Four stages: fine evaluation, then also fine light, the full mesh, and more rays.
    constexpr size_t kFirst = size_t(ErrorSource::Evaluation) + 1, kStages = 4;
    std::vector<std::array<glm::dvec3, kStages>> sums(lights.size());
    const size_t cellsPerBit = mTruth.count() / (baked.size() * 64);
    for (size_t i = 0; i < mTruth.count(); i++) {
        const float bakedShare = shareOfOnes(baked, i / cellsPerBit, 1),
                    fullShare = shareOfOnes(whole, i / cellsPerBit, 1),
                    fineShare = shareOfOnes(fine, 4 * i, 4);
        if (bakedShare + fullShare + fineShare == 0) continue;
        const vec3 local = point.frame.toLocal(mTruth.directions[i]);
        if (!(local.z > 0)) continue;
        const vec3 reflected = local.z * mTruth.solidAngles[i] * point.reflected(local);
        for (size_t light = 0; light < lights.size(); light++) {
            const vec3 coarse = reflected * lights[light].coarseOf[i];
            const vec3 full = reflected * lights[light].fine[i];
            sums[light][0] += glm::dvec3(bakedShare * coarse);
            sums[light][1] += glm::dvec3(bakedShare * full);
            sums[light][2] += glm::dvec3(fullShare * full);
            sums[light][3] += glm::dvec3(fineShare * full);
        }
    }
    for (size_t light = 0; light < lights.size(); light++)
        for (size_t stage = 0; stage < kStages; stage++)
            result[light][kFirst + stage] = vec3(sums[light][stage]) + bounced[light];
}

void StageTracer::tracePaths(const SurfacePoint& point, uint32_t number, std::span<const Light> lights,
                             std::span<const vec3> bounced, std::span<StageRadiance> result) const {
    constexpr auto kBounces = size_t(ErrorSource::Bounces), kMoreBounces = size_t(ErrorSource::MoreBounces);
    for (size_t light = 0; light < lights.size(); light++) {
        const PathScene scene{mBound, mSurfaces, mSurfaces, mMeshes, lights[light].paths, mFullOffset};
        std::array<vec3, kMostBounces> byBounces{};
        for (int path = 0; path < kStagePaths && mOptions.bounces > 0; path++) {
            HashedNumbers random(number, uint32_t(path));
            sampleBounces(scene, point, std::span(byBounces).first(size_t(mOptions.bounces)), random);
        }
        vec3 baked(0), more(0);
        for (size_t bounce = 0; bounce < byBounces.size(); bounce++)
            (bounce < size_t(mAsset.bounces) ? baked : more) += byBounces[bounce] / float(kStagePaths);
        StageRadiance& stages = result[light];
        stages[kBounces + 1] = stages[kBounces] - bounced[light] + baked;
        stages[kMoreBounces + 1] = stages[kMoreBounces] + more;
    }
}

std::vector<std::vector<StageRadiance>>
StageTracer::trace(std::span<const RayHit> points, vec3 eye, std::span<const StageLight> stageLights,
                   const std::function<void(double)>& progress) const {
    std::vector<Light> lights;
    for (const StageLight& light : stageLights) lights.push_back(prepare(light));

    Vertices vertices;
    for (const RayHit& hit : points) {
        const uvec3 corners = mAsset.parts[hit.mesh].mesh.triangles[hit.triangle];
        for (int corner = 0; corner < 3; corner++) vertices.tuples[vertexKey(hit.mesh, corners[corner])];
    }
    std::vector<std::pair<const uint64_t, Tuples>*> entries;
    for (auto& entry : vertices.tuples) entries.push_back(&entry);
    constexpr double kVertexShare = 0.4; // of the work, roughly
    SharedProgress vertexProgress(progress, 0, kVertexShare, entries.size());
    tbb::parallel_for(size_t(0), entries.size(), [&](size_t i) {
        const uint64_t key = entries[i]->first;
        entries[i]->second = vertexTuples(size_t(key >> 32), uint32_t(key), lights);
        vertexProgress.add();
    });

    std::vector<std::vector<StageRadiance>> result(lights.size(), std::vector<StageRadiance>(points.size()));
    SharedProgress pointProgress(progress, kVertexShare, 1, points.size());
    tbb::parallel_for(size_t(0), points.size(), [&](size_t i) {
        const RayHit& hit = points[i];
        const SurfacePoint point = mBound.pointAt(hit, eye);
        std::vector<StageRadiance> stages(lights.size());
        const SurfacePoint own = mBound.bakedPointAt(hit, eye);
        const bool isMapped = point.frame.n != own.frame.n;
        const std::vector<uint64_t> baked = mBaked.visibility(point.position, point.normal);
        const Binding binding = bindingAt(hit.mesh, own);
        const std::vector<UnshadowedLight> unshadowed =
            unshadowedAt(point, own, isMapped ? mBound.limitPointAt(hit, eye) : own, binding, lights);
        traceVertices(hit, binding, unshadowed, vertices, stages);
        const std::vector<vec3> bounced =
            traceOwnTransport(hit, point, own, binding, unshadowed, vertices, baked, lights, stages);
        traceTruth(point, baked, lights, bounced, stages);
        tracePaths(point, uint32_t(i), lights, bounced, stages);
        for (StageRadiance& ofLight : stages)
            for (vec3& radiance : ofLight) radiance += point.emitted;
        for (size_t light = 0; light < lights.size(); light++) result[light][i] = stages[light];
        pointProgress.add();
    });
    return result;
}

} // namespace relume
