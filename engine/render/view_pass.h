// View change: draws every part with its light-modulated tuples and view maps into a linear float image.
// Touches no transport.
#pragma once

#include "engine/image/image.h"
#include "engine/render/appearance.h"
#include "engine/render/relighter.h"
#include "engine/scene/camera.h"
#include "shaders/shared/render.h"

namespace relume {

struct ViewOptions {
    int width = 640, height = 480;
    // Terms that one draw interpolates; 0, or more than the device passes from vertex to fragment: as many
    // as it does.
    uint32_t termsPerDraw = 0;
};

class ViewPass {
  public:
    // Uploads meshes, view maps and textures. `asset` must outlive this. Throws OutOfMemory, or
    // Error when a part has more vertices than the device can bind, or the image is larger than it can make.
    ViewPass(const vk::Device& device, const Asset& asset, const ViewOptions& options = {});

    // A new image size; what was drawn is lost.
    void resize(int width, int height);

    // What parts wear from the next record() on; the default appearance until then. Nothing waits: the change
    // travels with the commands.
    void setAppearance(const Appearance& appearance);

    // Pass "view": draws the asset with the tuples recorded before.
    void record(vk::Commands& commands, const Camera& camera, const Relighter& relighter) const;

    // RGBA32F, linear, alpha 1 where covered, 0 elsewhere; in TRANSFER_SRC_OPTIMAL after record().
    const vk::Image& image() const { return mColor; }

    // The image of the last submission. Waits for the device.
    Image read() const;

    // One submission of record(), read back.
    Image render(const Camera& camera, const Relighter& relighter) const;

  private:
    // Terms of a part are drawn a few at a time: the first draw settles depth, further ones add where depth
    // is equal, and a last one clamps at zero; a part whose terms fit one draw clamps in the shader.
    struct Draw {
        uint32_t firstTerm;
        std::array<const vk::GraphicsProgram*, 3> programs; // by look; made ahead, so that no swap waits
    };
    struct Set {
        uint32_t terms = 0, materials = 0;
        DiskMapping mapping = DiskMapping::Orthographic;
        vk::Image viewMaps; // an image layer a layer and term
        std::vector<Draw> draws;
        bool clamps = false; // needs the last draw
    };
    struct Part {
        vk::Buffer vertices, indices;
        uint32_t indexCount = 0;
        uint32_t paint = 0; // how it is painted where it is
        vk::Image baseColor, materialMap;
        std::vector<Set> sets;
        vk::Buffer layers; // shared::ViewLayer, as many as can be worn
        PartAppearance worn;
        uint32_t look = 0; // what that asks of the shader
        std::vector<shared::ViewLayer> wornLayers;
    };

    Part makePart(const AssetPart& source);
    Set makeSet(const MaterialSet& source, const std::string& name);
    void planDraws(Set& set);
    static const Set& wornSet(const Part& part) { return part.sets[part.worn.set]; }
    struct Frame {
        mat4 clipFromWorld;
        vec3 eye;
    };
    void draw(vk::Commands& commands, const Frame& frame, const Part& part, uint32_t firstTerm,
              const vk::GraphicsProgram& program, const vk::Buffer& tuples) const;
    // `look`: shared::kSingleLook and so on.
    const vk::GraphicsProgram& program(uint32_t terms, bool first, bool clamps, uint32_t look);

    const vk::Device& mDevice;
    const Asset& mAsset;
    Bounds mBounds;
    uint32_t mTermsPerDraw;
    std::map<std::array<uint32_t, 4>, vk::GraphicsProgram> mPrograms; // by program()'s arguments
    vk::GraphicsProgram mClampProgram;
    vk::Sampler mDiskSampler, mPolarSampler, mSurfaceSampler; // the latter two wrap: in x, and all around
    std::vector<Part> mParts;
    vk::Image mColor, mDepth;
};

} // namespace relume
