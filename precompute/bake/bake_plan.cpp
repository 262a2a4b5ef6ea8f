#include "precompute/bake/bake_plan.h"

#include "engine/base/check.h"
#include "engine/base/hash.h"
#include "engine/transport/asset_arrays.h"
#include "engine/transport/asset_check.h"
#include "engine/transport/asset_meta.h"
#include "precompute/bake/vertex_order.h"
#include "precompute/brdf/material_factory.h"
#include "precompute/visibility/occluder.h"

#include <chrono>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace relume {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// Says where paint cannot show.
void checkPaint(const AssetPart& part) {
    constexpr size_t kPaintedMaterials = 4;
    if (!part.isPainted()) return;
    for (const MaterialSet& set : part.sets) {
        const std::string& first = set.materials.front().name;
        if (set.materials.size() == 1)
            spdlog::warn("{}: painted, but \"{}\" is alone in its set; the paint changes nothing", part.name,
                         first);
        if (set.materials.size() > kPaintedMaterials)
            spdlog::warn(
                "{}: paint has weights for {} materials; \"{}\" and what follows it cannot be painted",
                part.name, kPaintedMaterials, set.materials[kPaintedMaterials].name);
    }
}

nlohmann::json describe(const BakeOptions& options) {
    const FactorizationOptions& factorization = options.factorization;
    return {{"terms", factorization.terms},
            {"error", factorization.wantedError ? nlohmann::json(*factorization.wantedError) : nullptr},
            {"factorization", factorizationName(factorization.method)},
            {"coefficients", options.coefficients},
            {"map_size", options.mapSize},
            {"map", diskMappingName(options.mapping)},
            {"face_size", options.faceSize},
            {"visibility_size", options.visibilitySize},
            {"transport_samples", options.transportSamples},
            {"occluder_triangles", options.occluderTriangles},
            {"visibility", visibilityMethodName(*options.visibilityMethod)},
            {"vertex_order", "morton"}};
}

nlohmann::json describeInputs(const Scene& scene) {
    auto inputs = nlohmann::json::array();
    for (const Part& part : scene.parts) {
        inputs.push_back({{"name", part.name}, {"file", part.source}, {"hash", part.sourceHash}});
        for (const InputFile& texture : part.textureFiles)
            inputs.push_back({{"name", part.name}, {"file", texture.file}, {"hash", texture.hash}});
    }
    return inputs;
}

void makeParts(std::vector<Part> parts, BakePlan& plan) {
    const BakeOptions& options = plan.options;
    MaterialFactory materials(options.factorization, options.mapSize, options.mapping);
    for (Part& part : parts) {
        std::vector<MaterialSet> sets =
            materials.make(part.material, part.materialFolder, part.baseColor.has_value());
        for (MaterialSet& set : sets) {
            set.transport.vertices = uint32_t(part.mesh.vertexCount());
            set.transport.terms = uint32_t(set.brdf.terms);
        }
        plan.asset.parts.push_back({part.name, std::move(part.mesh), std::move(sets),
                                    std::move(part.baseColor), std::move(part.materialMap),
                                    part.paintedByColors});
        checkPaint(plan.asset.parts.back());
    }
}

void cutBlocks(BakePlan& plan) {
    plan.blockVertices = blockVertices(plan.asset);
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

template <typename Element>
void addTo(Hasher& hasher, const std::vector<Element>& elements) {
    const uint64_t bytes = elements.size() * sizeof(Element);
    hasher.add(std::as_bytes(std::span(&bytes, 1)));
    hasher.add(std::as_bytes(std::span(elements)));
}

// META holds every number and text of an asset, provenance included.
std::string identityOf(const Asset& asset) {
    size_t sets = 0;
    for (const AssetPart& part : asset.parts) sets += part.sets.size();
    const std::string meta = encodeMeta(asset, std::vector<uint64_t>(sets, 0));
    Hasher hasher;
    addTo(hasher, std::vector<char>(meta.begin(), meta.end()));
    forEachArray(
        asset, [&](ChunkTag, uint32_t, const auto& elements) { addTo(hasher, elements); },
        [](uint32_t, const MaterialSet&) {});
    return hasher.text();
}

} // namespace

uint64_t BakePlan::vertices() const {
    uint64_t sum = 0;
    for (const AssetPart& part : asset.parts) sum += part.mesh.vertexCount();
    return sum;
}

BakePlan planOf(Asset asset) {
    BakePlan plan;
    plan.asset = std::move(asset);
    cutBlocks(plan);
    plan.identity = identityOf(plan.asset);
    return plan;
}

void setVisibility(BakePlan& plan, VisibilityMethod method) {
    plan.options.visibilityMethod = method;
    plan.asset.provenance.options = describe(plan.options).dump();
    plan.identity = identityOf(plan.asset);
}

BakePlan planBake(const vk::Device& device, Scene scene, const BakeOptions& options, BakeObserver& observer) {
    options.validate();
    RELUME_CHECK(!scene.parts.empty());
    BakePlan plan{options};
    for (Part& part : scene.parts) orderVertices(part.mesh);

    Asset& asset = plan.asset;
    asset.faceSize = options.faceSize;
    asset.visibilitySize = options.visibilitySize;
    asset.coefficients = options.coefficients;
    asset.transportSamples = options.transportSamples;
    asset.provenance.program = "relume " RELUME_VERSION;
    asset.provenance.device = fmt::format("{}, {}", device.info().name, device.info().driver);
    asset.provenance.inputs = describeInputs(scene).dump();

    Clock::time_point stage = Clock::now();
    observer.stage(BakeStage::Occluder, "");
    Occluder occluder = makeOccluder(scene, options.occluderTriangles);
    asset.visibilityOffset = visibilityOffset(occluder, boundsOf(scene));
    asset.occluder = std::move(occluder.mesh);
    plan.occluderSeconds = secondsSince(stage);

    stage = Clock::now();
    observer.stage(BakeStage::Factorisation, "");
    makeParts(std::move(scene.parts), plan);
    plan.factorisationSeconds = secondsSince(stage);

    checkSkeleton(asset, "the bake");
    cutBlocks(plan);
    setVisibility(plan, options.visibilityMethod.value_or(VisibilityMethod::Traced));
    return plan;
}

} // namespace relume
