// Rasterized against traced visibility, on vertices of an asset.
#pragma once

#include "engine/image/image.h"
#include "engine/transport/asset.h"
#include "engine/vk/device.h"

#include <optional>

namespace relume {

struct VisibilityComparison {
    uint64_t hemisphere = 0; // texels above the horizons of all vertices
    uint64_t different = 0;  // of these
    // Of these, where the traced visibility of all eight neighbors in the face is the texel's own: no
    // silhouette passes near.
    uint64_t inside = 0;
    // The vertex with the most different texels, as a picture of its cube unfolded: +Y above and -Y below the
    // row -X, +Z, +X, -Z. White: seen, black: blocked, gray: below the horizon, red in a ring: different.
    Image picture;

    double share() const { return hemisphere > 0 ? double(different) / double(hemisphere) : 0; }
};

// Compares the visibility of `samples` vertices, spread evenly over the asset's. Returns nothing where the
// device can only draw.
std::optional<VisibilityComparison> compareVisibility(const vk::Device& device, const Asset& asset,
                                                      int samples);

} // namespace relume
