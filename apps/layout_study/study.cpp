#include "apps/layout_study/study.h"

#include "engine/base/hash.h"
#include "engine/base/progress.h"
#include "engine/light/light_vector.h"
#include "engine/render/compare.h"
#include "engine/render/relighter.h"
#include "engine/render/view_pass.h"
#include "engine/transport/asset_arrays.h"
#include "engine/transport/chunk_file.h"
#include "precompute/cpu/cpu_relighter.h"
#include "precompute/layout/conversion.h"
#include "precompute/reference/reference_image.h"

#include <cmath>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

constexpr LightSelection kAllLight{.threshold = 0};

// Σ (a - b)² and Σ b².
struct Difference {
    double lost = 0, all = 0;

    void add(vec3 a, vec3 b) {
        const glm::dvec3 difference(a - b), exact(b);
        lost += glm::dot(difference, difference);
        all += glm::dot(exact, exact);
    }
    double relative() const { return all > 0 ? std::sqrt(lost / all) : 0; }
};

Camera cameraOf(const Asset& asset, const StudyOptions& options) {
    // The object comes first, a ground after it.
    return defaultCamera(boundsOf(asset.parts.at(0).mesh), 0.6f,
                         float(options.width) / float(options.height));
}

uint64_t transportBytes(const Asset& asset) {
    uint64_t bytes = 0;
    for (const AssetPart& part : asset.parts)
        for (const MaterialSet& set : part.sets) bytes += bytesOf(set.transport);
    return bytes;
}

uint64_t transportOnDisk(const Asset& asset) {
    const std::vector<std::byte> bytes = encodeAsset(asset);
    uint64_t stored = 0;
    const ChunkFile file(bytes, "study");
    for (const ChunkEntry& entry : file.entries())
        if (entry.tag == kTransport || entry.tag == kClusters || entry.tag == kBases)
            stored += entry.storedSize;
    return stored;
}

double transportError(const Asset& asset, const Asset& exact, int rows) {
    uint64_t all = 0;
    for (const AssetPart& part : exact.parts)
        all += uint64_t(verticesOf(part.sets[0].transport)) * termsOf(part.sets[0].transport);
    const uint64_t step = std::max<uint64_t>(1, all / uint64_t(rows));
    const auto count = size_t(6 * exact.faceSize * exact.faceSize);
    Difference difference;
    uint64_t row = 0; // over all parts
    for (size_t part = 0; part < exact.parts.size(); part++) {
        const Transport &kept = asset.parts[part].sets[0].transport,
                        &whole = exact.parts[part].sets[0].transport;
        const uint64_t own = uint64_t(verticesOf(whole)) * termsOf(whole);
        for (uint64_t i = (step - row % step) % step; i < own; i += step) {
            const std::vector<vec3> a = coefficientsOf(kept, i, count), b = coefficientsOf(whole, i, count);
            for (size_t c = 0; c < count; c++) difference.add(a[c], b[c]);
        }
        row += own;
    }
    return difference.relative();
}

std::vector<std::vector<vec3>> tuplesOf(const Asset& asset, const LightVector& light) {
    std::vector<std::vector<vec3>> tuples;
    for (const AssetPart& part : asset.parts) {
        const Transport& transport = part.sets[0].transport;
        auto& own = tuples.emplace_back(size_t(verticesOf(transport)) * termsOf(transport));
        makeCpuRelighter(transport)->relight(light, own);
    }
    return tuples;
}

double relitError(const Asset& asset, const Asset& exact, const LightVector& light) {
    const auto a = tuplesOf(asset, light), b = tuplesOf(exact, light);
    Difference difference;
    for (size_t part = 0; part < a.size(); part++)
        for (size_t row = 0; row < a[part].size(); row++) difference.add(a[part][row], b[part][row]);
    return difference.relative();
}

std::vector<Image> render(const vk::Device& device, const Asset& asset, const StudyOptions& options) {
    LightPass light(device, asset.faceSize);
    Relighter relighter(device, asset);
    ViewPass view(device, asset, {.width = options.width, .height = options.height, .samples = 1});
    vk::Commands commands(device, "layout study");
    std::vector<Image> images;
    for (const LightCube& cube : options.lights) {
        light.setCube(cube);
        commands.begin();
        light.record(commands, 0, kAllLight);
        relighter.record(commands, light);
        view.record(commands, cameraOf(asset, options), relighter);
        commands.submitAndWait();
        images.push_back(view.read());
    }
    return images;
}

Variant measure(const vk::Device& device, const Asset& asset, const Asset& exact,
                const std::vector<Image>& references, const StudyOptions& options) {
    Variant variant;
    variant.layout = layoutOf(asset.parts.at(0).sets[0].transport);
    variant.name = layoutName(variant.layout);
    const auto vertices = double(verticesOf(asset));
    variant.bytes = double(transportBytes(asset)) / vertices;
    variant.onDisk = double(transportOnDisk(asset)) / vertices;
    variant.transportError = transportError(asset, exact, options.exactRows);
    const std::vector<Image> images = render(device, asset, options);
    for (size_t light = 0; light < options.lights.size(); light++) {
        variant.relitErrors.push_back(
            relitError(asset, exact, makeLightVector(options.lights[light], kAllLight)));
        variant.imageErrors.push_back(compareImages(images[light], references[light]).relativeRmse);
    }
    return variant;
}

// All that a reference is drawn of, but the options.
std::string surfaceOf(const Asset& asset) {
    std::string surface = fmt::format("lights of {} texels a side", asset.faceSize);
    const auto add = [&](const auto& values) { surface += ' ' + hashText(std::as_bytes(std::span(values))); };
    const auto addTexture = [&](const std::optional<Texture>& texture) {
        const Texture shown = texture.value_or(Texture{});
        surface += fmt::format(" {} x {} {}", shown.width, shown.height, shown.srgb);
        add(shown.texels);
    };
    for (const AssetPart& part : asset.parts) {
        add(part.mesh.positions);
        add(part.mesh.normals);
        add(part.mesh.triangles);
        add(part.mesh.uvs);
        add(part.mesh.colors);
        add(part.mesh.tangents);
        addTexture(part.baseColor);
        addTexture(part.materialMap);
        surface += fmt::format(" painted {}", part.paintedByColors);
        for (const AssetMaterial& material : part.sets[0].materials)
            surface += fmt::format(" {} {}", material.description, material.hasBase);
    }
    return surface;
}

} // namespace

const std::vector<Image>& References::of(const Asset& asset) {
    const std::string surface = surfaceOf(asset);
    if (surface == mSurface) return mImages;
    mSurface = surface;
    mImages.clear();
    Progress progress("tracing references", mOptions.lights.size() * uint64_t(mOptions.height), "rows");
    ReferenceOptions options;
    options.width = mOptions.width;
    options.height = mOptions.height;
    options.samples = 1;
    options.raysPerTexelSide = 1;
    for (const LightCube& light : mOptions.lights) {
        const uint64_t before = mImages.size() * uint64_t(mOptions.height);
        mImages.push_back(renderReference(asset, cameraOf(asset, mOptions), light, options,
                                          [&](int rows) { progress.update(before + uint64_t(rows)); }));
    }
    return mImages;
}

BakeStudy studyBake(const vk::Device& device, const std::string& name, const Asset& asset,
                    References& references, const StudyOptions& options) {
    BakeStudy study;
    study.name = name;
    study.vertices = verticesOf(asset);
    study.terms = termsOf(asset.parts.at(0).sets.at(0).transport);
    const std::vector<Image>& images = references.of(asset);
    study.source = measure(device, asset, asset, images, options);
    struct Way {
        LayoutOptions layout;
        std::optional<int> coefficients; // of rows
    };
    std::vector<Way> ways;
    for (const int coefficients : options.rows)
        ways.push_back({{.layout = TransportLayout::Rows}, coefficients});
    for (const TransportLayout layout : {TransportLayout::Clusters, TransportLayout::Bases})
        for (const double budget : options.budgets)
            ways.push_back({{.layout = layout, .bytesPerVertex = budget}, {}});
    Progress progress("converting " + name, ways.size(), "variants");
    for (const Way& way : ways) {
        Asset converted = asset;
        convertLayout(converted, way.layout, {}, way.coefficients);
        study.variants.push_back(measure(device, converted, asset, images, options));
        progress.update(study.variants.size());
    }
    return study;
}

} // namespace relume
