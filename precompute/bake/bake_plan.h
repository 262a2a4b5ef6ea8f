// Everything that is decided about a bake before its first vertex is baked.
#pragma once

#include "engine/import/scene.h"
#include "engine/transport/asset.h"
#include "engine/vk/device.h"
#include "precompute/bake/bake_options.h"
#include "precompute/bake_observer.h"
#include "precompute/layout/layout_scale.h"

namespace relume {

// Vertices [first, end) of a part: the unit of work, of checkpoints and of runs in the file.
struct BakeBlock {
    uint32_t part, first, end;

    uint32_t count() const { return end - first; }
};

constexpr size_t kIdentityBytes = 32; // hexadecimal digits of BakePlan::identity

class BouncedTransport;

struct BakePlan {
    BakeOptions options;
    Asset asset; // complete except for rows (their numbers are set) and measured errors
    // How blocks are encoded, in layouts other than rows; set once a sample is baked (layout_sample.h).
    std::optional<LayoutScale> scale;
    // Bounced light, which is added to blocks as they are baked. Null before it is computed, and without
    // bounces.
    std::shared_ptr<const BouncedTransport> bounced;
    uint32_t blockVertices = 0, visibilityRun = 0; // in vertices; visibilityRun divides blockVertices
    std::vector<BakeBlock> blocks;                 // ordered by part, then by vertex
    std::vector<uint32_t> firstSet;                // per part: index of its first set, counted over all parts
    std::string visibilityKey;                     // content_hash.h
    // Hash of everything that determines the file's bytes: program and kernels, device and driver, options,
    // and the asset. Blocks baked from plans of equal identity can be combined.
    std::string identity;
    double factorizationSeconds = 0, occluderSeconds = 0;

    uint64_t vertices() const;
    size_t setCount() const;                 // of all parts
    bool needsScale() const;                 // whether blocks are encoded with a scale, from a sample
    std::vector<uint32_t> allBlocks() const; // the numbers of all blocks, rising
};

// Plans a bake: puts vertices in bake order (vertex_order.h), makes the occluder, factors the materials and
// refines the meshes if `options` ask for it. Uses only the name and the capabilities of the device. Where
// `options` leave the visibility method open, the plan is for Traced. Throws Error.
BakePlan planBake(const vk::Device& device, Scene scene, const BakeOptions& options, BakeObserver& observer);

// Plans a bake of an existing asset with other materials: returns the plan of planBake() for the meshes,
// occluder, textures and inputs of `skeleton`, an asset read without rows (readSkeleton). `materials` has one
// text per part, as readMaterials() takes it, with paths relative to the current folder; a part whose text is
// empty keeps its materials, factored anew if `options` require it. All `options` that affect visibility must
// be those of the asset. Throws Error.
BakePlan planRebake(const vk::Device& device, Asset skeleton, const std::vector<std::string>& materials,
                    const BakeOptions& options, BakeObserver& observer);

// Returns the plan from which `asset` (without rows) was baked, except for its options. `visibilityKey` is
// that of its kept visibility; empty for none.
BakePlan planOf(Asset asset, const std::string& visibilityKey = {});

// Replaces the transport of every set by an empty one in the layout of the plan's options.
void prepareTransport(BakePlan& plan);

} // namespace relume
