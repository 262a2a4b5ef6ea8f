// A bake, on the device to be drawn and on the host to be queried.
#pragma once

#include "engine/render/view_pass.h"
#include "precompute/cpu/cpu_visibility.h"
#include "precompute/visibility/ray_tracer.h"

#include <filesystem>

namespace relume {

struct Model {
    // Reads and uploads a bake, which takes a while. Throws Error.
    Model(const vk::Device& device, const std::filesystem::path& path);
    // Takes a sketch (precompute/bake/sketch.h), to be shown unshadowed until there is a bake at `path`.
    Model(const vk::Device& device, const std::filesystem::path& path, Asset sketch);
    Model(const Model&) = delete;
    Model& operator=(const Model&) = delete;

    std::filesystem::path file;
    bool isSketch;
    Asset asset;
    Bounds bounds;                        // of the object
    std::optional<GroundFade> groundFade; // of GroundStyle::Shadow
    Appearance appearance;
    LightPass light;
    Relighter relighter;
    ViewPass view;
    RayTracer surfaces;     // one mesh per part
    CpuVisibility occluder; // the mesh that casts shadows in the bake

  private:
    Model(const vk::Device& device, const std::filesystem::path& path, Asset asset, bool isSketch);
};

// Returns the largest K of the parts' first sets.
int termsOf(const Model& model);

// Returns the hit of the ray through a pixel, given from the upper left of an image of this size; none if it
// misses.
std::optional<RayHit> pick(const Model& model, const Camera& camera, vec2 pixel, ivec2 size);

// Returns the position of a hit.
vec3 positionOf(const Model& model, const RayHit& hit);

} // namespace relume
