// Relighting on the CPU as fast as plain C++ goes, in any layout: for advice, and as the yardstick of
// `relume bench relight`.
#pragma once

#include "engine/light/light_vector.h"
#include "engine/transport/transport.h"

#include <memory>
#include <span>

namespace relume {

class CpuRelighter {
  public:
    virtual ~CpuRelighter() = default;

    // The tuples of relight() (precompute/twins/relight_twin.h), a vec3 per row, on all cores.
    virtual void relight(const LightVector& light, std::span<vec3> tuples) const = 0;
};

// `transport` must outlive it.
std::unique_ptr<CpuRelighter> makeCpuRelighter(const Transport& transport);

} // namespace relume
