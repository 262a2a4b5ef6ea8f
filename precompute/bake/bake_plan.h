// What a bake will do, decided before any vertex is baked.
#pragma once

#include "engine/scene/scene.h"
#include "engine/transport/asset.h"
#include "engine/vk/device.h"
#include "precompute/bake/bake_observer.h"
#include "precompute/bake/bake_options.h"

namespace relume {

// Vertices [first, end) of a part: the unit of work, of checkpoints, and of a run in the file.
struct BakeBlock {
    uint32_t part, first, end;

    uint32_t count() const { return end - first; }
};

struct BakePlan {
    BakeOptions options;
    Asset asset; // all but the rows, whose numbers are set, and the measured errors
    uint32_t blockVertices = 0;
    std::vector<BakeBlock> blocks;  // part after part, in vertex order
    std::vector<uint32_t> firstSet; // per part: its first set's number, counted over all parts
    // Content hash of everything that decides the file's bytes: program, device and driver, options, and all
    // of the asset. Results of plans with equal identities can be joined.
    std::string identity;
    double factorisationSeconds = 0, occluderSeconds = 0;

    uint64_t vertices() const;
};

// Puts vertices in bake order (vertex_order.h), makes the occluder and factors the materials. The device only
// gives its name. Options that leave the visibility's method open give a plan for Traced. Throws Error.
BakePlan planBake(const vk::Device& device, Scene scene, const BakeOptions& options, BakeObserver& observer);

// The plan that a bake had whose asset this is, rows left out, but for its options.
BakePlan planOf(Asset asset);

// Decides how visibility is found, and the identity with it.
void setVisibility(BakePlan& plan, VisibilityMethod method);

} // namespace relume
