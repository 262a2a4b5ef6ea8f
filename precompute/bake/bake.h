// From a scene to an asset: the passes in order.
#pragma once

#include "engine/scene/scene.h"
#include "engine/transport/asset.h"
#include "engine/vk/commands.h"
#include "precompute/bake/bake_options.h"

#include <functional>

namespace relume {

// Where a bake's time went.
struct BakeTimes {
    double total = 0; // wall-clock seconds, all told
    double factorisation = 0;
    double occluder = 0;  // merging and simplifying
    vk::PassTimes device; // device seconds by pass
    uint32_t batch = 0;   // most points of a submission
};

// Called between submissions with the number of vertices done, of all parts.
using BakeProgress = std::function<void(uint64_t done)>;

// Bakes every part. Vertices are put in bake order (vertex_order.h). The same scene, options and device give
// the same asset. Throws Error; out of device memory halves the batch and goes on, saying so.
Asset bake(const vk::Device& device, Scene scene, const BakeOptions& options,
           const BakeProgress& progress = {}, BakeTimes* times = nullptr);

} // namespace relume
