// Selects, quantizes and packs the rows of one vertex on the CPU.
#pragma once

#include "precompute/bake/transport_pass.h"
#include "precompute/cpu/cpu_transport.h"

namespace relume {

// Rows of one vertex, concatenated term by term.
struct CpuRows {
    std::vector<uint32_t> counts; // row entries per term
    std::vector<float> scales;    // per term
    std::vector<uint16_t> indices;
    std::vector<uint32_t> values;
    TransportLosses losses;
};

// Keeps the `kept` largest coefficients of every term, like selectLargest() and packRow() in
// precompute/twins/transport_twin.h.
class CpuRowPacker {
  public:
    CpuRowPacker(const CpuTransport& transport, int kept) : mTransport(transport), mKept(size_t(kept)) {}

    void pack(const CpuCoefficients& coefficients, CpuRows& rows);

  private:
    void select(const CpuCoefficients& coefficients, int group, int lane);

    const CpuTransport& mTransport;
    size_t mKept;
    // Workspace.
    std::vector<float> mBounds;
    std::vector<uint64_t> mCandidates; // key, then tie-breaker, then place among the blocks
    std::vector<uint32_t> mSelected;   // index, then place
};

} // namespace relume
