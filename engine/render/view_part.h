// A part of an asset as ViewPass draws it: mesh, textures and view maps on the device, and what is bound.
#pragma once

#include "engine/render/appearance.h"
#include "engine/render/map_texture.h"
#include "engine/render/triangle_clusters.h"
#include "engine/vk/buffer.h"
#include "engine/vk/image.h"
#include "shaders/shared/render.h"

namespace relume {

// A set of materials of a part.
struct ViewSet {
    uint32_t terms = 0, materials = 0;
    DiskMapping mapping = DiskMapping::Orthographic;
    ViewMapTexture viewMaps;
    bool hasTangents = false; // whether frames follow from tangents
    vk::Buffer directShares;  // of the material set; none if it has none
};

// Part of an asset, with the materials that are bound to it.
struct ViewPart {
    // Uploads a part whose triangles are numbered from `firstTriangleId`. Throws OutOfMemory, or Error if it
    // has more vertices or triangles than the device can bind.
    ViewPart(const vk::Device& device, const AssetPart& source, uint32_t firstTriangleId);

    // Binds materials of the part that it was made of.
    void bind(const AssetPart& source, const PartAppearance& appearance);
    const ViewSet& boundSet() const { return sets[bound.set]; }

    Bounds bounds;
    bool isClosed;
    vk::Buffer drawnPositions, drawnTriangles; // NumberedTriangles
    vk::Buffer vertices, triangles;            // shared::ViewVertex and corners, looked up by pixels
    TriangleClusters clusters;
    uint32_t firstTriangleId, triangleCount; // ids are from 1, over all parts
    uint32_t paint;                          // shared::kPaintedByMap and so on, if it is painted
    vk::Image baseColor, materialMap, normalMap, emissionMap;
    shared::ViewDetail detail;
    bool isDetailed; // whether `detail` has anything to draw
    std::vector<ViewSet> sets;
    vk::Buffer layers; // shared::ViewDetail, then as many shared::ViewLayer as can be bound
    PartAppearance bound;
    uint32_t look = 0; // what the bound layers need of the shader: shared::kSingleLook and so on
    std::vector<shared::ViewLayer> boundLayers;
};

// Returns the looks that a part can have with this set bound, of bindings that show something.
std::vector<uint32_t> looksOf(const AssetPart& part, const MaterialSet& set);

} // namespace relume
