// What a bake will do, decided before any vertex is baked.
#pragma once

#include "engine/import/scene.h"
#include "engine/transport/asset.h"
#include "engine/vk/device.h"
#include "precompute/bake/bake_options.h"
#include "precompute/bake_observer.h"
#include "precompute/layout/layout_scale.h"

namespace relume {

// Vertices [first, end) of a part: the unit of work, of checkpoints, and of a run in the file.
struct BakeBlock {
    uint32_t part, first, end;

    uint32_t count() const { return end - first; }
};

class BouncedTransport;

struct BakePlan {
    BakeOptions options;
    Asset asset; // all but the rows, whose numbers are set, and the measured errors
    // What encodes blocks that are not kept in rows: known once a sample of them is baked (layout_sample.h).
    std::optional<LayoutScale> scale;
    // Bounced light, which is added to blocks as they are baked. Null until it was found, and where none is
    // asked for.
    std::shared_ptr<const BouncedTransport> bounced;
    uint32_t blockVertices = 0, visibilityRun = 0; // vertices; the second divides the first
    std::vector<BakeBlock> blocks;                 // part after part, in vertex order
    std::vector<uint32_t> firstSet;                // per part: its first set's number, counted over all parts
    std::string visibilityKey;                     // visibility_key.h
    // Content hash of everything that decides the file's bytes: program and kernels, device and driver,
    // options, and all of the asset. Results of plans with equal identities can be joined.
    std::string identity;
    double factorisationSeconds = 0, occluderSeconds = 0;

    uint64_t vertices() const;
};

// Puts vertices in bake order (vertex_order.h), makes the occluder, factors the materials and refines the
// meshes where `options` ask for it. The device only gives its name. Options that leave the visibility's
// method open give a plan for Traced. Throws Error.
BakePlan planBake(const vk::Device& device, Scene scene, const BakeOptions& options, BakeObserver& observer);

// For the meshes, occluder, textures and inputs of a bake that was read without rows (readSkeleton): gives
// the plan that planBake() gives for the same with these materials. `materials`: of every part as
// readMaterials() takes them, paths being relative to the current folder; where it is empty, the part keeps
// its own, factored anew if `options` ask for that. `options` must agree with the bake's own in all that
// decides visibility. Throws Error.
BakePlan planRebake(const vk::Device& device, Asset skeleton, const std::vector<std::string>& materials,
                    const BakeOptions& options, BakeObserver& observer);

// The plan that a bake had whose asset this is, rows left out, but for its options. `visibilityKey`: of its
// kept visibility; empty for none.
BakePlan planOf(Asset asset, const std::string& visibilityKey = {});

// Makes the transport of every set empty, in the layout that the plan's options name.
void prepareTransport(BakePlan& plan);

// Decides how visibility is found, and the identity with it.
void setVisibility(BakePlan& plan, VisibilityMethod method);

} // namespace relume
