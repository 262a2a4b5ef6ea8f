#include "precompute/bake/bake_plan.h"

#include "engine/base/check.h"
#include "engine/base/log.h"
#include "engine/base/stopwatch.h"
#include "engine/transport/asset_arrays.h"
#include "engine/transport/asset_check.h"
#include "engine/transport/asset_meta.h"
#include "precompute/bake/baked_options.h"
#include "precompute/bake/bounced_transport.h"
#include "precompute/bake/content_hash.h"
#include "precompute/bake/tangents.h"
#include "precompute/bake/transport_pass.h"
#include "precompute/bake/vertex_order.h"
#include "precompute/bounce/bounce_gather_pass.h"
#include "precompute/brdf/brdf.h"
#include "precompute/brdf/material_factory.h"
#include "precompute/layout/conversion.h"
#include "precompute/layout/layout_scale.h"
#include "precompute/layout/layouts.h"
#include "precompute/refine/refinement.h"
#include "precompute/residual/residuals.h"
#include "precompute/visibility/occluder.h"

#include <algorithm>
#include <fmt/core.h>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

namespace relume {

namespace {

// Warns where paint has no effect.
void checkPaint(const AssetPart& part) {
    constexpr size_t kPaintedMaterials = 4;
    if (!part.isPainted()) return;
    for (const MaterialSet& set : part.sets) {
        const std::string& first = set.materials.front().name;
        if (set.materials.size() == 1)
            log(LogLevel::Warning,
                fmt::format("{}: painted, but \"{}\" is alone in its set; the paint changes nothing",
                            part.name, first));
        if (set.materials.size() > kPaintedMaterials)
            log(LogLevel::Warning,
                fmt::format(
                    "{}: paint has weights for {} materials; \"{}\" and what follows it cannot be painted",
                    part.name, kPaintedMaterials, set.materials[kPaintedMaterials].name));
    }
}

nlohmann::json describeInputs(const Scene& scene) {
    auto inputs = nlohmann::json::array();
    for (const Part& part : scene.parts) {
        inputs.push_back({{"name", part.name}, {"file", part.source}, {"hash", part.sourceHash}});
        if (part.brushRotation != 0) inputs.back()["brush_rotation"] = part.brushRotation;
        for (const InputFile& texture : part.textureFiles)
            inputs.push_back({{"name", part.name}, {"file", texture.file}, {"hash", texture.hash}});
    }
    return inputs;
}

// Recognizes brushed parts. Makes each BRDF once, since measured data is read from a file.
class BrushedParts {
  public:
    bool has(const AssetPart& part) {
        bool isAny = false;
        for (const MaterialSet& set : part.sets)
            for (const AssetMaterial& material : set.materials) isAny |= !isIsotropic(material.description);
        return isAny;
    }

  private:
    bool isIsotropic(const std::string& description) {
        const auto [known, isNew] = mKnown.emplace(description, true);
        if (isNew) known->second = makeBrdf(description)->isIsotropic();
        return known->second;
    }

    std::map<std::string, bool> mKnown;
};

// Keeps tangents for anisotropic materials only. The frames of others follow from their normals, so that
// their unshadowed light is a function of the normal (docs/residual.md).
void setTangents(AssetPart& part, float brushRotation, BrushedParts& brushed, BakeObserver& observer) {
    if (!brushed.has(part)) {
        part.mesh.tangents.clear();
        if (brushRotation != 0)
            log(LogLevel::Warning,
                fmt::format("{}: the brush rotation changes nothing; none of its materials is brushed "
                            "(ashikhmin-shirley or ggx with two different widths, gltf with anisotropy)",
                            part.name));
    } else if (!makeTangents(part.mesh, brushRotation, [&] { return observer.wantsStop(); }))
        throw BakeStopped("stopped");
}

void makeParts(std::vector<Part> parts, BakePlan& plan, BakeObserver& observer) {
    const BakeOptions& options = plan.options;
    BrushedParts brushed;
    MaterialFactory materials(options.factorization, options.mapSize, options.mapping);
    for (Part& part : parts) {
        std::vector<MaterialSet> sets =
            materials.make(part.material, part.materialFolder, part.baseColor || part.tintedByColors);
        plan.asset.parts.push_back({part.name, std::move(part.mesh), std::move(sets),
                                    std::move(part.baseColor), std::move(part.materialMap),
                                    part.paintedByColors, part.tintedByColors, std::move(part.detail)});
        checkPaint(plan.asset.parts.back());
        setTangents(plan.asset.parts.back(), part.brushRotation, brushed, observer);
    }
    makeResiduals(plan.asset);
}

// Returns the goal of --refine ERROR (all parts) or of --refine auto (coarse parts).
RefinementGoal goalOf(const RefinementRecord& record, const Scene& scene) {
    if (!record.isAuto) return {.wanted = record.wanted};
    RefinementGoal goal{.wanted = record.wanted, .isRefined = std::vector<bool>(scene.parts.size(), false)};
    uint64_t given = 0;
    for (size_t i = scene.parts.size(); i-- > 0;) { // the ground comes last, and must be included
        const Part& part = scene.parts[i];
        const uint64_t vertices = part.mesh.vertexCount();
        if (part.keepsVertices || vertices >= kCoarseVertices || given + vertices > kMostAutoGiven) continue;
        goal.isRefined[i] = true;
        given += vertices;
    }
    goal.mostVertices = given + kMostAutoVertices;
    return goal;
}

// Refines the meshes. The occluder remains, being the same surface with fewer triangles.
void refineMeshes(const RefinementGoal& goal, BakePlan& plan, BakeObserver& observer) {
    Asset& asset = plan.asset;
    RefinementRecord& record = *plan.options.refinement;
    const bool isAuto = record.isAuto;
    record = refine(asset.parts, asset.occluder, asset.visibilityOffset, goal, observer);
    record.isAuto = isAuto;
    for (size_t number = 0; number < asset.parts.size(); number++)
        if (goal.isRefined.empty() || goal.isRefined[number]) orderVertices(asset.parts[number].mesh);
    observer.refined(record);
}

void cutBlocks(BakePlan& plan) {
    plan.blockVertices = blockVertices(plan.asset);
    plan.visibilityRun = visibilityRunVertices(plan.asset);
    uint32_t sets = 0;
    for (uint32_t number = 0; number < plan.asset.parts.size(); number++) {
        const AssetPart& part = plan.asset.parts[number];
        const auto vertices = uint32_t(part.mesh.vertexCount());
        for (uint32_t first = 0; first < vertices; first += plan.blockVertices)
            plan.blocks.push_back({number, first, first + std::min(plan.blockVertices, vertices - first)});
        plan.firstSet.push_back(sets);
        sets += uint32_t(part.sets.size());
    }
}

// Hashes META, which holds every number and text of an asset, and everything else that determines its bytes.
std::string identityOf(const BakePlan& plan) {
    size_t sets = 0;
    for (const AssetPart& part : plan.asset.parts) sets += part.sets.size();
    ContentHash hash;
    const std::vector<std::byte> meta =
        encodeMeta(plan.asset, sizesOf(plan.asset, std::vector<uint64_t>(sets, 0)),
                   plan.options.keepVisibility ? plan.visibilityKey : "");
    hash.add(std::span(meta));
    for (const Kernels& kernels : {visibilityKernels(VisibilityMethod::Raster),
                                   visibilityKernels(VisibilityMethod::Traced), TransportPass::kernels()})
        for (const auto kernel : kernels) hash.add(kernel);
    hash.add(std::span(&kLayoutEncoderVersion, 1));
    if (plan.asset.bounces > 0) {
        hash.add(std::span(&kBouncesVersion, 1));
        for (const auto kernel : BounceGatherPass::kernels()) hash.add(kernel);
    }
    forEachArray(
        plan.asset,
        [&](ChunkTag tag, uint32_t, const auto& elements) {
            // Shares are baked: a shard's asset has them, that of a bake which begins has not.
            if (tag != kDirectShares) hash.add(std::span(elements));
        },
        [](uint32_t, const MaterialSet&) {});
    return hash.text();
}

// Sets sizes and provenance, except for the inputs and what finish() sets.
void describeTo(const vk::Device& device, const BakeOptions& options, Asset& asset) {
    asset.faceSize = options.faceSize;
    asset.visibilitySize = options.visibilitySize;
    asset.coefficients = options.coefficients;
    asset.transportSamples = options.transportSamples;
    asset.bounces = options.bounces;
    asset.provenance.program = "relume " RELUME_VERSION;
    asset.provenance.device = fmt::format("{}, {}", device.info().name, device.info().driver);
}

// Returns whether a set has several materials.
bool sharesTerms(const Asset& asset) {
    for (const AssetPart& part : asset.parts)
        for (const MaterialSet& set : part.sets)
            if (set.materials.size() > 1) return true;
    return false;
}

void leaveOutBounces(BakePlan& plan) {
    if (plan.options.bounces > 0)
        log(LogLevel::Info,
            "direct light alone: the terms that materials of a set share are too few for light that "
            "bounces; --bounces asks for it all the same");
    plan.options.bounces = plan.asset.bounces = 0;
}

void finish(BakePlan& plan) {
    if (!plan.options.layout.error) plan.options.layout.error = defaultLayoutError(plan.asset);
    prepareTransport(plan);
    checkSkeleton(plan.asset, "the bake");
    cutBlocks(plan);
    plan.asset.provenance.options = describeOptions(plan.options);
    plan.visibilityKey = visibilityKey(plan.asset, plan.options.visibilityMethod);
    plan.identity = identityOf(plan);
}

} // namespace

uint64_t BakePlan::vertices() const { return vertexCount(asset); }

BakePlan planOf(Asset asset, const std::string& visibilityKey) {
    BakePlan plan;
    plan.asset = std::move(asset);
    plan.options.keepVisibility = !visibilityKey.empty();
    plan.visibilityKey = visibilityKey;
    cutBlocks(plan);
    plan.identity = identityOf(plan);
    return plan;
}

bool BakePlan::needsScale() const {
    return isCompressed(layoutOf(asset.parts.front().sets.front().transport));
}

size_t BakePlan::setCount() const { return firstSet.back() + asset.parts.back().sets.size(); }

std::vector<uint32_t> BakePlan::allBlocks() const {
    std::vector<uint32_t> all(blocks.size());
    std::iota(all.begin(), all.end(), 0u);
    return all;
}

void prepareTransport(BakePlan& plan) {
    const LayoutOptions& options = plan.options.layout;
    plan.asset.layout.reset();
    if (isCompressed(options.layout)) plan.asset.layout = recordOf(options, 0);
    for (AssetPart& part : plan.asset.parts)
        for (MaterialSet& set : part.sets) {
            set.transport =
                emptyTransport(options.layout, uint32_t(part.mesh.vertexCount()), uint32_t(set.brdf.terms));
            std::visit([&](auto& layout) { prepareLayout(layout, set.brdf, plan.asset.bounces > 0); },
                       set.transport);
        }
}

BakePlan planBake(const vk::Device& device, Scene scene, const BakeOptions& options, BakeObserver& observer) {
    makeSumsDeterministic();
    options.validate();
    RELUME_CHECK(!scene.parts.empty());
    BakePlan plan{options};
    plan.options.visibilityMethod = usableMethod(device, options.visibilityMethod);
    for (Part& part : scene.parts) orderVertices(part.mesh);

    Asset& asset = plan.asset;
    describeTo(device, options, asset);
    // Names of files may be any bytes, and JSON is UTF-8.
    asset.provenance.inputs =
        describeInputs(scene).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);

    Stopwatch watch;
    observer.stage(BakeStage::Occluder, "");
    Occluder occluder = makeOccluder(scene, options.occluderTriangles);
    asset.visibilityOffset = visibilityOffset(occluder, boundsOf(scene));
    asset.occluder = std::move(occluder.mesh);
    plan.occluderSeconds = watch.seconds();

    RefinementGoal goal;
    if (options.refinement) goal = goalOf(*options.refinement, scene);
    if (!goal.isRefined.empty() && std::ranges::count(goal.isRefined, true) == 0)
        plan.options.refinement.reset(); // nothing is coarse

    watch.restart();
    observer.stage(BakeStage::Factorization, "");
    makeParts(std::move(scene.parts), plan, observer);
    plan.factorizationSeconds = watch.seconds();
    if (plan.options.areBouncesAuto && sharesTerms(asset)) leaveOutBounces(plan);

    if (plan.options.refinement) refineMeshes(goal, plan, observer);
    finish(plan);
    return plan;
}

BakePlan planRebake(const vk::Device& device, Asset skeleton, const std::vector<std::string>& materials,
                    const BakeOptions& options, BakeObserver& observer) {
    makeSumsDeterministic();
    options.validate();
    RELUME_CHECK_EQ(materials.size(), skeleton.parts.size());
    const BakeOptions own = optionsOf(skeleton);
    const bool isFactoredSo = options.factorization == own.factorization && options.mapSize == own.mapSize &&
                              options.mapping == own.mapping;
    BakePlan plan{options};
    plan.asset = std::move(skeleton);
    describeTo(device, options, plan.asset);
    plan.asset.truncationError = plan.asset.quantizationError = 0;
    const bool didShareTerms = sharesTerms(plan.asset); // any bounces were then asked for explicitly

    const Stopwatch watch;
    observer.stage(BakeStage::Factorization, "");
    MaterialFactory factory(options.factorization, options.mapSize, options.mapping);
    BrushedParts brushed;
    for (size_t number = 0; number < plan.asset.parts.size(); number++) {
        AssetPart& part = plan.asset.parts[number];
        if (materials[number].empty() && isFactoredSo) continue;
        const std::string text = materials[number].empty() ? materialsOf(part) : materials[number];
        part.sets = factory.make(text, {}, part.hasBaseColor());
        checkPaint(part);
        if (part.mesh.tangents.empty() || !brushed.has(part)) setTangents(part, 0, brushed, observer);
    }
    makeResiduals(plan.asset);
    plan.factorizationSeconds = watch.seconds();
    if (options.areBouncesAuto && !didShareTerms && sharesTerms(plan.asset)) leaveOutBounces(plan);
    finish(plan);
    return plan;
}

} // namespace relume
