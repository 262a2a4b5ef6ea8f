// Compares rasterized with traced visibility at vertices of an asset.
#pragma once

#include "engine/image/image.h"
#include "engine/transport/asset.h"
#include "engine/vk/device.h"

#include <optional>

namespace relume {

struct VisibilityComparison {
    uint64_t hemisphere = 0; // texels above the horizons of all vertices
    uint64_t different = 0;  // of these, texels that differ
    // Number of differing texels whose eight neighbors in the face all have the same traced visibility:
    // no silhouette is near.
    uint64_t inside = 0;
    // The vertex with the most differing texels: its cube unfolded, with +Y above and -Y below the row -X,
    // +Z, +X, -Z. White: unoccluded; black: occluded; gray: below the horizon; red in a ring: different.
    Image picture;

    double share() const { return hemisphere > 0 ? double(different) / double(hemisphere) : 0; }
};

// Compares the visibility of `samples` vertices, spread evenly over the asset's. Returns nothing if the
// device cannot trace.
std::optional<VisibilityComparison> compareVisibility(const vk::Device& device, const Asset& asset,
                                                      int samples);

} // namespace relume
