// A part's BRDFs as tables of S × S directions on either side: the limit of K terms for large K.
#pragma once

#include "engine/render/appearance.h"
#include "precompute/brdf/factorization.h"
#include "precompute/brdf/material_brdfs.h"
#include "precompute/brdf/tabulation.h"

#include <map>

namespace relume {

class TabulatedBrdf {
  public:
    // Tabulates these layers' BRDFs as `set` was factored from, by this method. Throws as makeBrdf() and
    // tabulate() do.
    TabulatedBrdf(const MaterialSet& set, std::span<const BoundLayer> layers, Factorization method,
                  MaterialBrdfs& brdfs);

    // Returns f(·, outgoing) as a light map of S × S texels, extended beyond the disk as light maps are: the
    // sum of `layers`, which must be among those given to the constructor, times their weights. `outgoing` is
    // in the local frame, above the horizon.
    std::vector<vec3> lightMap(std::span<const BoundLayer> layers, std::span<const vec3> weights,
                               vec3 outgoing) const;

  private:
    using Channels = std::array<Eigen::MatrixXf, 3>;
    int mSize;
    DiskMapping mMapping;
    size_t mDirections = 0;
    std::vector<int> mNearest;       // per texel: the direction whose values it has
    std::map<int, Channels> mLayers; // by BoundLayer::layer
};

} // namespace relume
