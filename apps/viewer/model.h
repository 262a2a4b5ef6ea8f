// A bake on the device, ready to be drawn, and on the host, ready to be asked.
#pragma once

#include "engine/render/view_pass.h"
#include "precompute/cpu/cpu_visibility.h"
#include "precompute/visibility/ray_tracer.h"

#include <filesystem>

namespace relume {

struct Model {
    // Reads and uploads; takes a while. Throws Error.
    Model(const vk::Device& device, const std::filesystem::path& path);
    // Of a sketch (precompute/bake/sketch.h): what the bake at this path will be, unshadowed.
    Model(const vk::Device& device, const std::filesystem::path& path, Asset sketch);
    Model(const Model&) = delete;
    Model& operator=(const Model&) = delete;

    std::filesystem::path file;
    bool isSketch;
    Asset asset;
    Bounds bounds; // of the object
    std::optional<GroundFade> groundFade;
    Appearance appearance;
    LightPass light;
    Relighter relighter;
    ViewPass view;
    RayTracer surfaces;     // one mesh per part
    CpuVisibility occluder; // what cast the shadows of the bake

  private:
    Model(const vk::Device& device, const std::filesystem::path& path, Asset asset, bool isSketch);
};

// The largest K of its parts' first sets.
int termsOf(const Model& model);

// What a pixel's ray meets, the pixel given from the upper left of an image of this size; none: nothing.
std::optional<RayHit> pick(const Model& model, const Camera& camera, vec2 pixel, ivec2 size);

// Where that is.
vec3 positionOf(const Model& model, const RayHit& hit);

} // namespace relume
