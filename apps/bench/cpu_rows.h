// Selection, quantization and packing of one vertex's rows on the CPU.
#pragma once

#include "precompute/bake/transport_pass.h"
#include "precompute/cpu/cpu_transport.h"

namespace relume {

// Rows of one vertex, term after term, end to end.
struct CpuRows {
    std::vector<uint32_t> counts; // entries, per term
    std::vector<float> scales;    // per term
    std::vector<uint16_t> indices;
    std::vector<uint32_t> values;
    TransportLosses losses;
};

// Keeps the `kept` largest coefficients of every term: selectLargest and packRow in
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
    std::vector<uint64_t> mCandidates; // key, then what breaks ties, then the place among the blocks
    std::vector<uint32_t> mSelected;   // index, then place
};

} // namespace relume
