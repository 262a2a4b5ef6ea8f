// What a bake would find at a point, in a few numbers: how it answers to random light.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/cpu/cpu_transport.h"
#include "precompute/cpu/cpu_visibility.h"

#include <array>

namespace relume {

// Random lights: of each, Haar coefficients are +1 or -1 times lightSpectrum(), in all directions. A vertex's
// answers to them are a random projection of its transport as light weighs it: for two vertices, the mean
// square of the difference of their answers is, within a fifth, the sum of the squared differences of all
// their weighted coefficients.
constexpr int kProbeLights = 64;
using ProbeAnswers = std::array<float, kProbeLights>;

// The lights at the probes' own size, texel after texel along the CPU baker's curve, kProbeLights floats
// each.
class ProbeLights {
  public:
    static constexpr int kFaceSize = 32; // F of the probes: fine enough to tell vertices apart

    ProbeLights();

    const float* texel(size_t place) const { return &mValues[place * kProbeLights]; }

  private:
    std::vector<float> mValues;
};

// Probes points of one part. Terms weigh as much as their view maps show of them, so that answers are of
// reflected light.
class TransportProbe {
  public:
    // Keeps references to `visibility`, of faces of kVisibilitySize, and `lights`.
    TransportProbe(const AssetPart& part, const CpuVisibility& visibility, const ProbeLights& lights);

    static constexpr int kVisibilitySize = 64;

    // One thread's.
    struct Workspace {
        std::vector<uint64_t> bits;
        CpuCoefficients texels;
        std::vector<float> sums;
    };
    Workspace makeWorkspace() const;

    // At a point already lifted off the surface. Thread-safe; the same on any thread.
    ProbeAnswers answers(vec3 origin, const TangentFrame& frame, Workspace& workspace) const;

  private:
    const CpuVisibility& mVisibility;
    const ProbeLights& mLights;
    CpuTransport mTransport;
};

} // namespace relume
