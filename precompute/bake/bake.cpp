#include "precompute/bake/bake.h"

#include "precompute/bake/part_passes.h"
#include "precompute/bake/vertex_order.h"
#include "precompute/brdf/material_factory.h"
#include "precompute/visibility/occluder.h"

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace relume {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void bakePart(const vk::Device& device, const Asset& asset, const BakeOptions& options, AssetPart& part,
              TransportLosses& losses, BakeTimes& times, const BakeProgress& progress) {
    const auto vertices = uint32_t(part.mesh.vertexCount());
    for (MaterialSet& set : part.sets) {
        set.transport.vertices = vertices;
        set.transport.terms = uint32_t(set.brdf.terms);
        set.transport.rowStarts = {0};
    }
    PartPasses passes(device, asset, part, options);
    times.batch = std::max(times.batch, passes.batch());
    std::vector<SparseTransport*> transports;
    for (MaterialSet& set : part.sets) transports.push_back(&set.transport);
    std::vector<shared::BakePoint> points;
    for (uint32_t first = 0; first < vertices; first += passes.batch()) {
        const uint32_t end = std::min(vertices, first + passes.batch());
        points.clear();
        for (uint32_t vertex = first; vertex < end; vertex++)
            points.push_back(bakePoint(part.mesh, vertex, asset.visibilityOffset));
        passes.bake(points, transports, losses);
        if (progress) progress(end);
    }
    for (const auto& [name, seconds] : passes.times()) vk::addTime(times.device, name, seconds);
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
            {"visibility", visibilityMethodName(options.visibilityMethod)},
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

float relative(double lost, double total) { return total > 0 ? float(std::sqrt(lost / total)) : 0; }

} // namespace

Asset bake(const vk::Device& device, Scene scene, const BakeOptions& options, const BakeProgress& progress,
           BakeTimes* timesOut) {
    options.validate();
    RELUME_CHECK(!scene.parts.empty());
    const Clock::time_point start = Clock::now();
    BakeTimes times;
    for (Part& part : scene.parts) orderVertices(part.mesh);

    Asset asset;
    asset.faceSize = options.faceSize;
    asset.visibilitySize = options.visibilitySize;
    asset.coefficients = options.coefficients;
    asset.transportSamples = options.transportSamples;
    asset.provenance.device = fmt::format("{}, {}", device.info().name, device.info().driver);
    asset.provenance.options = describe(options).dump();
    asset.provenance.inputs = describeInputs(scene).dump();

    Clock::time_point stage = Clock::now();
    Occluder occluder = makeOccluder(scene, options.occluderTriangles);
    asset.visibilityOffset = visibilityOffset(occluder, boundsOf(scene));
    asset.occluder = std::move(occluder.mesh);
    times.occluder = secondsSince(stage);

    stage = Clock::now();
    MaterialFactory materials(options.factorization, options.mapSize, options.mapping);
    for (Part& part : scene.parts) {
        std::vector<MaterialSet> sets =
            materials.make(part.material, part.materialFolder, part.baseColor.has_value());
        asset.parts.push_back({part.name, std::move(part.mesh), std::move(sets), std::move(part.baseColor),
                               std::move(part.materialMap), part.paintedByColors});
        checkPaint(asset.parts.back());
    }
    times.factorisation = secondsSince(stage);

    TransportLosses losses;
    uint64_t done = 0;
    for (AssetPart& part : asset.parts) {
        bakePart(device, asset, options, part, losses, times, [&](uint64_t vertices) {
            if (progress) progress(done + vertices);
        });
        done += part.mesh.vertexCount();
    }
    asset.truncationError = relative(losses.dropped, losses.total);
    asset.quantisationError = relative(losses.quantised, losses.total - losses.dropped);
    times.total = secondsSince(start);
    if (timesOut) *timesOut = times;
    return asset;
}

} // namespace relume
