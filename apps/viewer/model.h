// A bake on the device, ready to be drawn.
#pragma once

#include "engine/render/view_pass.h"

#include <filesystem>

namespace relume {

struct Model {
    // Reads and uploads; takes a while. Throws Error.
    Model(const vk::Device& device, const std::filesystem::path& path);
    Model(const Model&) = delete;
    Model& operator=(const Model&) = delete;

    std::filesystem::path file;
    Asset asset;
    Bounds bounds; // of the object
    Appearance appearance;
    LightPass light;
    Relighter relighter;
    ViewPass view;
};

} // namespace relume
