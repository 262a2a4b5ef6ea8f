#include "precompute/twins/verification.h"

#include "engine/math/cubemap.h"
#include "engine/math/haar.h"
#include "engine/render/relighter.h"
#include "precompute/bake/baked_options.h"
#include "precompute/bake/batch_plan.h"
#include "precompute/bake/bounced_transport.h"
#include "precompute/bake/transport_pass.h"
#include "precompute/bounce/bounce_gather.h"
#include "precompute/brdf/factorization_error.h"
#include "precompute/reference/bound_asset.h"
#include "precompute/twins/bounce_twin.h"
#include "precompute/twins/relight_twin.h"
#include "precompute/twins/transport_twin.h"
#include "precompute/twins/vertex_check.h"
#include "precompute/visibility/visibility.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace relume {

namespace {

// Accumulates Σ|a - b|² and Σ|b|² for a relative error.
struct ErrorSum {
    double difference = 0, reference = 0;
    void add(vec3 value, vec3 expected) {
        difference += glm::dot(value - expected, value - expected);
        reference += glm::dot(expected, expected);
    }
    double relative() const { return reference > 0 ? std::sqrt(difference / reference) : 0; }
};

struct Sums {
    uint64_t mismatched = 0, hemisphere = 0;
    ErrorSum transport, wavelet, quantization, layout, total, bounce;
    double brdf = 0;
    bool haveRows = false;
};

// Runs the device's stages for some points of a part; reads back visibility bits and all coefficients.
class DeviceStages {
  public:
    DeviceStages(const vk::Device& device, const Asset& asset, const AssetPart& part, const MaterialSet& set,
                 const std::vector<uint32_t>& vertices)
        : mFaceCoefficients(6ull * asset.faceSize * asset.faceSize), mTerms(uint32_t(set.brdf.terms)) {
        BakeOptions options;
        options.factorization.terms = set.brdf.terms;
        options.coefficients = asset.coefficients;
        options.faceSize = asset.faceSize;
        options.visibilitySize = asset.visibilitySize;
        options.transportSamples = asset.transportSamples;
        const VisibilityMethod method = usableMethod(device, optionsOf(asset).visibilityMethod);
        options.visibilityMethod = method;
        const uint32_t together = TransportPass::largestBatch(device, options) / mTerms;
        const uint64_t entries = uint64_t(mTerms) * uint64_t(options.coefficients);
        const uint32_t batch =
            std::max(1u, std::min(planBatch(device, options, int(mTerms), entries), together));
        const auto size = uint32_t(asset.visibilitySize);
        const uint64_t bitBytes = visibilityBytes(size);

        const vk::Buffer points(device, batch * sizeof(shared::BakePoint), vk::BufferUse::Upload, "points");
        const auto visibility = makeVisibility(device, method, asset.occluder, size, batch,
                                               visibilityNearDistance(asset.visibilityOffset));
        TransportTuning tuning = TransportTuning::of(device);
        tuning.coefficientBytes = ~0ull; // all points at once, to read back all coefficients
        const TransportPass transport(device, set.brdf, options, batch, tuning);
        const vk::Buffer bits(device, batch * bitBytes, vk::BufferUse::Device, "visibility bits");
        const vk::Buffer bitsBack(device, batch * bitBytes, vk::BufferUse::Readback, "visibility bits back");
        const uint64_t pointBytes = mTerms * PackingPass::coefficientBytes(options.faceSize);
        const vk::Buffer coefficientsBack(device, batch * pointBytes, vk::BufferUse::Readback,
                                          "coefficients back");
        vk::Commands commands(device, "verify");
        for (uint32_t first = 0; first < vertices.size(); first += batch) {
            const uint32_t count = std::min(batch, uint32_t(vertices.size()) - first);
            for (uint32_t i = 0; i < count; i++)
                points.map<shared::BakePoint>()[i] =
                    bakePoint(part.mesh, vertices[first + i], asset.visibilityOffset);
            commands.begin();
            commands.fill(transport.coefficients(), 0); // zeros are not written
            commands.barrier(vk::Stage::Transfer, vk::Stage::Compute);
            visibility->record(commands, points, count, bits);
            transport.record(commands, points, count, bits);
            commands.barrier(vk::Stage::Compute, vk::Stage::Transfer);
            commands.copy(bits, bitsBack, count * bitBytes);
            commands.copy(transport.coefficients(), coefficientsBack, count * pointBytes);
            commands.barrier(vk::Stage::Transfer, vk::Stage::Host);
            commands.submitAndWait();
            visibility->check();
            for (uint32_t point = 0; point < count; point++) {
                const auto words = bitsBack.map<uint32_t>().subspan(point * bitBytes / 4, bitBytes / 4);
                std::vector<uint8_t>& cube = mVisibility.emplace_back(words.size() * 32);
                for (size_t texel = 0; texel < cube.size(); texel++)
                    cube[texel] = words[texel / 32] >> texel % 32 & 1;
                for (uint32_t term = 0; term < mTerms; term++) {
                    const size_t rowSlots = PackingPass::coefficientBytes(options.faceSize) / sizeof(vec3);
                    const auto slots =
                        coefficientsBack.map<vec3>().subspan((point * mTerms + term) * rowSlots, rowSlots);
                    std::vector<vec3>& row = mCoefficients.emplace_back();
                    for (size_t i = 0; i < mFaceCoefficients; i++)
                        row.push_back(slots[haarSlot(i, size_t(asset.faceSize))]);
                }
            }
        }
    }

    const std::vector<uint8_t>& visibility(size_t point) const { return mVisibility[point]; }
    const std::vector<vec3>& coefficients(size_t point, size_t term) const {
        return mCoefficients[point * mTerms + term];
    }

  private:
    uint64_t mFaceCoefficients;
    uint32_t mTerms;
    std::vector<std::vector<uint8_t>> mVisibility;
    std::vector<std::vector<vec3>> mCoefficients; // by row
};

// Bounced transport, computed anew, and the rows that its last bounce was gathered from.
class Bounces {
  public:
    Bounces(const vk::Device& device, const Asset& asset)
        : mAsset(asset), mBound(defaultAppearance(asset)), mGains(sourceGains(asset, mBound)),
          mTracer(partMeshes(asset)) {
        BakeObserver silent;
        mBounced = bouncedTransportOf(device, asset, silent, &mFrom);
    }

    void addTo(std::vector<vec3>& coefficients, size_t part, size_t set, size_t row) const {
        mBounced->addTo(coefficients, part, set, row, mAsset.faceSize);
    }

    // Compares one bounced row with the twin's.
    void check(size_t part, size_t set, uint32_t vertex, int term, ErrorSum& sum) const {
        constexpr int kDirections = 64; // per side of a face of their cube
        const std::vector<vec3> expected =
            bouncedVector(mAsset, mBound, mGains, mTracer, mFrom, part, vertex, set, term, kDirections);
        const SparseTransport& rows = mBounced->rows(part, set);
        std::vector<vec3> found(expected.size(), vec3(0));
        rows.dequantizeRow(size_t(vertex) * rows.terms + size_t(term), found);
        for (size_t i = 0; i < expected.size(); i++) sum.add(found[i], expected[i]);
    }

  private:
    const Asset& mAsset;
    Appearance mBound;
    std::vector<std::vector<vec3>> mGains;
    RayTracer mTracer;
    std::vector<SparseTransport> mFrom;
    std::shared_ptr<const BouncedTransport> mBounced;
};

void checkVertex(const Asset& asset, size_t partIndex, size_t setIndex, uint32_t vertex,
                 const RayTracer& tracer, const DeviceStages& device, size_t point, const Bounces* bounces,
                 Sums& sums) {
    const AssetPart& part = asset.parts[partIndex];
    const MaterialSet& set = part.sets[setIndex];
    const vec3 normal = part.mesh.normals[vertex];
    const VertexReference reference = recomputeVertex(asset, partIndex, setIndex, vertex, tracer);
    const std::vector<uint8_t>& visibility = device.visibility(point);
    const int size = asset.visibilitySize;
    for (int texel = 0; texel < 6 * size * size; texel++) {
        const int face = texel / (size * size), y = texel / size % size, x = texel % size;
        if (glm::dot(cubeTexelDirection(face, x, y, size), normal) <= 0) continue;
        sums.hemisphere++;
        sums.mismatched += visibility[size_t(texel)] != reference.visibility[size_t(texel)];
    }
    for (int term = 0; term < set.brdf.terms; term++) {
        std::vector<vec3> expected = transportVector(visibility, size, asset.faceSize, asset.transportSamples,
                                                     set.brdf, term, frameOf(part.mesh, vertex));
        haarForwardFaces(expected, asset.faceSize);
        std::vector<vec3> found = device.coefficients(point, size_t(term));
        for (size_t i = 0; i < expected.size(); i++) sums.transport.add(found[i], expected[i]);

        const size_t row = size_t(vertex) * size_t(set.brdf.terms) + size_t(term);
        const std::vector<vec3> stored = dequantizedRow(set.transport, row, expected.size());
        std::vector<vec3> exact = reference.terms[size_t(term)].coefficients;
        if (bounces) {
            bounces->check(partIndex, setIndex, vertex, term, sums.bounce);
            bounces->addTo(found, partIndex, setIndex, row);
            bounces->addTo(exact, partIndex, setIndex, row);
        }
        for (size_t i = 0; i < expected.size(); i++) {
            sums.layout.add(stored[i], found[i]);
            sums.total.add(stored[i], exact[i]);
        }
        if (isCompressed(layoutOf(set.transport))) continue;
        sums.haveRows = true;
        std::vector<bool> kept(expected.size(), false);
        for (uint16_t index : selectLargest(found, asset.coefficients)) kept[index] = true;
        for (size_t i = 0; i < expected.size(); i++) {
            sums.wavelet.add(kept[i] ? found[i] : vec3(0), found[i]);
            if (kept[i]) sums.quantization.add(stored[i], found[i]);
        }
    }
}

// Draws vertices at random; returns those of each part, ascending.
std::map<size_t, std::vector<uint32_t>> drawSamples(const Asset& asset, int samples) {
    const uint64_t vertices = vertexCount(asset);
    std::mt19937_64 random(20040621);
    std::map<size_t, std::vector<uint32_t>> drawn;
    for (int sample = 0; sample < samples; sample++) {
        uint64_t vertex = random() % vertices;
        size_t part = 0;
        while (vertex >= asset.parts[part].mesh.vertexCount())
            vertex -= asset.parts[part++].mesh.vertexCount();
        drawn[part].push_back(uint32_t(vertex));
    }
    for (auto& [part, list] : drawn) std::sort(list.begin(), list.end());
    return drawn;
}

// Returns the number of vertices whose tuples differ from the CPU's.
uint64_t countDifferences(const Transport& transport, const LightVector& light,
                          const std::vector<vec3>& found) {
    const std::vector<vec3> expected = relight(transport, light);
    uint64_t different = 0;
    const uint32_t vertices = verticesOf(transport), terms = termsOf(transport);
    for (size_t vertex = 0; vertex < vertices; vertex++) {
        const auto begin = ptrdiff_t(vertex * terms), end = begin + ptrdiff_t(terms);
        different += !std::equal(found.begin() + begin, found.begin() + end, expected.begin() + begin);
    }
    return different;
}

// Returns the mean error over the materials of a set.
double brdfError(const MaterialSet& set) {
    double sum = 0;
    for (const AssetMaterial& material : set.materials)
        sum += double(rmsErrors(*makeBrdf(material.description), set.brdf, material.layer, material.layers())
                          .relative.back());
    return sum / double(set.materials.size());
}

uint64_t countRelightDifferences(const vk::Device& device, const Asset& asset, const Environment& prepared,
                                 float rotation) {
    LightPass light(device, asset.faceSize);
    light.setEnvironment(prepared);
    Relighter relighter(device, asset);
    vk::Commands commands(device, "verify relighting");
    commands.begin();
    light.record(commands, rotation);
    commands.submitAndWait();
    const LightVector vector = light.readVector();
    size_t mostSets = 0;
    for (const AssetPart& part : asset.parts) mostSets = std::max(mostSets, part.sets.size());
    uint64_t different = 0;
    for (size_t index = 0; index < mostSets; index++) {
        Appearance appearance = defaultAppearance(asset);
        for (size_t part = 0; part < appearance.size(); part++)
            appearance[part].set = std::min(index, asset.parts[part].sets.size() - 1);
        commands.begin();
        relighter.record(commands, light, appearance);
        commands.submitAndWait();
        for (size_t part = 0; part < asset.parts.size(); part++)
            if (index < asset.parts[part].sets.size())
                different += countDifferences(asset.parts[part].sets[index].transport, vector,
                                              relighter.readTuples(part, index));
    }
    return different;
}

} // namespace

Verification verify(const vk::Device& device, const Asset& asset, const Environment& prepared, float rotation,
                    int samples) {
    const Mesh* occluder = &asset.occluder;
    const RayTracer tracer({&occluder, 1});
    std::optional<Bounces> bounces;
    if (asset.bounces > 0) bounces.emplace(device, asset);
    Sums sums;
    for (const auto& [partIndex, vertices] : drawSamples(asset, samples)) {
        const AssetPart& part = asset.parts[partIndex];
        for (size_t set = 0; set < part.sets.size(); set++) {
            const DeviceStages stages(device, asset, part, part.sets[set], vertices);
            for (size_t point = 0; point < vertices.size(); point++)
                checkVertex(asset, partIndex, set, vertices[point], tracer, stages, point,
                            bounces ? &*bounces : nullptr, sums);
            sums.brdf += brdfError(part.sets[set]) * double(vertices.size()) / double(part.sets.size());
        }
    }
    Verification result;
    result.samples = uint64_t(samples);
    result.visibilityMismatch = double(sums.mismatched) / double(std::max<uint64_t>(sums.hemisphere, 1));
    result.transportError = sums.transport.relative();
    if (sums.haveRows) result.rows = {sums.wavelet.relative(), sums.quantization.relative()};
    result.brdfError = sums.brdf / samples;
    result.relightBits = countRelightDifferences(device, asset, prepared, rotation);
    result.bounceError = sums.bounce.relative();
    result.layoutError = sums.layout.relative();
    result.totalError = sums.total.relative();
    return result;
}

} // namespace relume
