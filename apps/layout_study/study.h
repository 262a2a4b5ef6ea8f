// What layouts of transport lose for what they cost.
#pragma once

#include "engine/light/light_cube.h"
#include "engine/transport/asset.h"
#include "engine/vk/device.h"
#include "precompute/layout/layout_options.h"

#include <string>
#include <vector>

namespace relume {

struct StudyOptions {
    std::vector<int> rows;               // N
    std::vector<double> budgets;         // of clusters and bases: bytes a vertex
    std::vector<std::string> lightNames; // per light
    std::vector<LightCube> lights;       // sampled at the bake's face size
    int width = 320, height = 240;       // of images
    int exactRows = 2000;                // that the error of transport is measured over
};

// One way to keep a bake's transport.
struct Variant {
    TransportLayout layout;
    std::string name;             // "rows", "clusters", "bases"
    double bytes = 0, onDisk = 0; // a vertex: of transport in memory, and compressed in its file
    // Relative L2: of coefficients against the bake's; per light of tuples under all of the light against the
    // bake's, and of an image against one that is ray-traced with the exact BRDF.
    double transportError = 0;
    std::vector<double> relitErrors, imageErrors;
};

struct BakeStudy {
    std::string name;
    uint64_t vertices = 0;
    uint32_t terms = 0;
    Variant source; // the bake as it is: the floor of what its conversions reach
    std::vector<Variant> variants;
};

// Images that bakes are held against, per light. Bakes share those of the bake before if they have the same
// parts, shapes, textures, paint and materials, and lights of the same size.
class References {
  public:
    explicit References(const StudyOptions& options) : mOptions(options) {}
    const std::vector<Image>& of(const Asset& asset);

  private:
    const StudyOptions& mOptions;
    std::string mSurface; // that the images are of
    std::vector<Image> mImages;
};

// `asset` is in rows.
BakeStudy studyBake(const vk::Device& device, const std::string& name, const Asset& asset,
                    References& references, const StudyOptions& options);

} // namespace relume
