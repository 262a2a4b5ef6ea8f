#include "precompute/refine/transport_probe.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"
#include "engine/math/haar.h"
#include "precompute/cpu/cpu_visibility.h"
#include "precompute/transport/light_spectrum.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace relume {

namespace {

// Returns the root mean square of a term's view maps over all layers.
float shownOf(const FactoredBrdf& brdf, int term) {
    double sum = 0;
    for (int layer = 0; layer < brdf.layers; layer++)
        for (size_t texel = 0; texel < brdf.mapTexels(); texel++) {
            const vec3 value = brdf.viewMap(layer, term)[texel];
            sum += double(glm::dot(value, value)) / 3;
        }
    return float(std::sqrt(sum / double(brdf.mapTexels() * size_t(brdf.layers))));
}

CpuTransport weightedTransport(const AssetPart& part) {
    std::vector<FactoredBrdf> weighted;
    for (const MaterialSet& set : part.sets) {
        weighted.push_back(set.brdf);
        FactoredBrdf& brdf = weighted.back();
        for (int term = 0; term < brdf.terms; term++) {
            const float shown = shownOf(brdf, term);
            for (size_t texel = 0; texel < brdf.mapTexels(); texel++)
                brdf.lightMaps[size_t(term) * brdf.mapTexels() + texel] *= shown;
        }
    }
    std::vector<const FactoredBrdf*> brdfs;
    for (const FactoredBrdf& brdf : weighted) brdfs.push_back(&brdf);
    return CpuTransport(brdfs, ProbeLights::kFaceSize, TransportProbe::kVisibilitySize, 1);
}

} // namespace

ProbeLights::ProbeLights() : mValues(size_t(kCubeFaces * kFaceSize * kFaceSize) * kProbeLights) {
    constexpr size_t kFaceTexels = size_t(kFaceSize) * kFaceSize;
    const std::vector<float> spectrum = lightSpectrum(kFaceSize);
    std::mt19937 random; // default seed: the same on every machine
    std::vector<vec3> face(kFaceTexels);
    for (size_t light = 0; light < kProbeLights; light++)
        for (size_t f = 0; f < kCubeFaces; f++) {
            for (size_t i = 0; i < kFaceTexels; i++)
                face[i] = vec3(random() & 1 ? spectrum[f * kFaceTexels + i] : -spectrum[f * kFaceTexels + i]);
            haarInverse(face, kFaceSize);
            for (size_t i = 0; i < kFaceTexels; i++) {
                const ivec2 place = mortonPlace(uint32_t(i));
                mValues[(f * kFaceTexels + i) * kProbeLights + light] =
                    face[size_t(place.y * kFaceSize + place.x)].x;
            }
        }
}

double ProbeLights::whiteEnergy() const {
    std::array<double, kProbeLights> responses{};
    for (int face = 0; face < kCubeFaces; face++)
        for (uint32_t i = 0; i < uint32_t(kFaceSize * kFaceSize); i++) {
            const ivec2 place = mortonPlace(i);
            const vec3 direction = cubeTexelDirection(face, place.x, place.y, kFaceSize);
            if (direction.y <= 0) continue;
            const float* light = texel(size_t(face * kFaceSize * kFaceSize) + i);
            const double share = double(direction.y * cubeTexelSolidAngle(place.x, place.y, kFaceSize) / kPi);
            for (size_t j = 0; j < kProbeLights; j++) responses[j] += share * double(light[j]);
        }
    double energy = 0;
    for (const double response : responses) energy += 3 * response * response; // of three channels
    return energy;
}

TransportProbe::TransportProbe(const AssetPart& part, const CpuVisibility& visibility,
                               const ProbeLights& lights)
    : mVisibility(visibility), mLights(lights), mTransport(weightedTransport(part)),
      mHasResiduals(
          std::ranges::all_of(part.sets, [](const MaterialSet& set) { return set.residual != nullptr; })) {
    RELUME_CHECK_EQ(visibility.texels(), size_t(kCubeFaces * kVisibilitySize * kVisibilitySize));
}

TransportProbe::Workspace TransportProbe::makeWorkspace() const {
    Workspace workspace{std::vector<uint64_t>(mVisibility.texels() / 64), mTransport.makeWorkspace(), {}};
    workspace.sums.resize(size_t(workspace.texels.stride) * kProbeLights);
    return workspace;
}

ProbedPoint TransportProbe::probe(vec3 origin, const TangentFrame& frame, Workspace& workspace) const {
    mVisibility.trace(origin, frame.n, workspace.bits);
    ProbedPoint point{.seen = responses(frame, workspace)};
    if (mHasResiduals) {
        // Directions below the horizon are blocked too, and have no transport.
        for (uint64_t& bits : workspace.bits) bits = ~bits;
        point.blocked = responses(frame, workspace);
    }
    return point;
}

ProbeResponses TransportProbe::responses(const TangentFrame& frame, Workspace& workspace) const {
    constexpr size_t kBlock = CpuCoefficients::kBlock;
    CpuCoefficients& texels = workspace.texels;
    mTransport.evaluate(frame, workspace.bits, texels);
    const auto stride = size_t(texels.stride);
    ProbeResponses responses{};
    // Random signs per light, term and channel, so that terms and channels do not add up.
    std::mt19937_64 random;
    for (int group = 0; group < texels.groups; group++) {
        std::ranges::fill(workspace.sums, 0.0f);
        for (size_t block = 0; block < texels.blocks.size(); block++)
            for (size_t i = 0; i < kBlock; i++) {
                const float* values = texels.block(group, block) + i * stride;
                const float* light = mLights.texel(texels.blocks[block] * kBlock + i);
                for (size_t lane = 0; lane < stride; lane++) {
                    if (values[lane] == 0) continue;
                    float* sums = &workspace.sums[lane * kProbeLights];
                    for (size_t j = 0; j < kProbeLights; j++) sums[j] += values[lane] * light[j];
                }
            }
        for (size_t lane = 0; lane < stride; lane++) {
            const uint64_t signs = random();
            const float* sums = &workspace.sums[lane * kProbeLights];
            for (size_t j = 0; j < kProbeLights; j++)
                responses[j] += (signs >> j & 1) != 0 ? sums[j] : -sums[j];
        }
    }
    return responses;
}

} // namespace relume
