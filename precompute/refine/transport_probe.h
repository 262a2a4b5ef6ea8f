// Summarizes the transport at a point in a few numbers, by a random projection.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/cpu/cpu_transport.h"
#include "precompute/cpu/cpu_visibility.h"

#include <array>

namespace relume {

// Random lights, whose Haar coefficients are +1 or -1 times lightSpectrum(). The responses of a vertex to
// them are a random projection of its weighted transport: the mean squared difference of two vertices'
// responses is, within a fifth, the sum of the squared differences of all their weighted coefficients.
constexpr int kProbeLights = 64;
using ProbeResponses = std::array<float, kProbeLights>;

// The lights, at the resolution of the probes: kProbeLights floats per texel, texels in Morton order.
class ProbeLights {
  public:
    static constexpr int kFaceSize = 32; // F of the probes: sufficient to tell vertices apart

    ProbeLights();

    const float* texel(size_t place) const { return &mValues[place * kProbeLights]; }

    // Returns the sum of the squared responses of a white diffuse surface that nothing shadows.
    double whiteEnergy() const;

  private:
    std::vector<float> mValues;
};

// The responses of a point.
struct ProbedPoint {
    ProbeResponses seen{};    // of its transport
    ProbeResponses blocked{}; // of what is hidden of its unshadowed transport; 0 unless hasResiduals()
};

// Probes points of one part. Terms are weighted by the RMS of their view maps, so that projections are of
// reflected light.
class TransportProbe {
  public:
    // Keeps references to `visibility`, whose faces have kVisibilitySize, and `lights`.
    TransportProbe(const AssetPart& part, const CpuVisibility& visibility, const ProbeLights& lights);

    static constexpr int kVisibilitySize = 64;

    // Workspace of one thread.
    struct Workspace {
        std::vector<uint64_t> bits;
        CpuCoefficients texels;
        std::vector<float> sums;
    };
    Workspace makeWorkspace() const;

    // Returns whether all sets of the part have a residual. Then unshadowed light is found at every pixel,
    // and only the share of it that arrives is interpolated (docs/residual.md).
    bool hasResiduals() const { return mHasResiduals; }

    // Probes a point that is already lifted off the surface. Thread-safe and deterministic.
    ProbedPoint probe(vec3 origin, const TangentFrame& frame, Workspace& workspace) const;

  private:
    // Returns the responses of the transport of the directions in workspace.bits.
    ProbeResponses responses(const TangentFrame& frame, Workspace& workspace) const;

    const CpuVisibility& mVisibility;
    const ProbeLights& mLights;
    CpuTransport mTransport;
    bool mHasResiduals;
};

} // namespace relume
