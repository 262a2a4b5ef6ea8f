// Relighting on the CPU in plain, fast C++, for any layout. Used by advice, and by `relume bench relight` as
// the yardstick.
#pragma once

#include "engine/light/light_vector.h"
#include "engine/transport/transport.h"

#include <memory>
#include <span>

namespace relume {

class CpuRelighter {
  public:
    virtual ~CpuRelighter() = default;

    // Computes the tuples of relight() (precompute/twins/relight_twin.h), one vec3 per row, on all cores.
    virtual void relight(const LightVector& light, std::span<vec3> tuples) const = 0;
};

// Keeps a reference to `transport`, which must outlive it.
std::unique_ptr<CpuRelighter> makeCpuRelighter(const Transport& transport);

} // namespace relume
