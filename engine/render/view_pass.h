// View change: draws every part with its light-modulated tuples and view maps into a linear float image.
// Touches no transport. First it draws which triangle every sample of every pixel sees, then it shades
// pixels: once where one smooth surface is seen, else once for each. What is seen stays while the camera
// does: then a new light is only shaded. docs/view_speed.md says why.
#pragma once

#include "engine/image/image.h"
#include "engine/render/appearance.h"
#include "engine/render/ground_fade.h"
#include "engine/render/map_texture.h"
#include "engine/render/pixel_samples.h"
#include "engine/render/relighter.h"
#include "engine/render/triangle_clusters.h"
#include "engine/scene/camera.h"
#include "shaders/shared/render.h"

namespace relume {

struct ViewOptions {
    int width = 640, height = 480;
    int samples = kDefaultSamples; // as setSamples()
    // Whether parts with a residual are drawn as if nothing shadowed them, whatever their transport is.
    bool isUnshadowed = false;
};

// What an image shows instead of radiance: triangles' edges; normals, as normal maps are colored; how much
// smaller (red) or larger (blue) triangles are than the asset's median.
enum class Inspect { Off, Wireframe, Normals, Density };

class ViewPass {
  public:
    // Uploads meshes, view maps and textures. `asset` must outlive this. Throws OutOfMemory, or
    // Error when a part has more vertices than the device can bind, or the image is larger than it can make.
    ViewPass(const vk::Device& device, const Asset& asset, const ViewOptions& options = {});

    // A new image size; what was drawn is lost.
    void resize(int width, int height);

    // Samples a pixel from the next record() on, 1, 2, 4 or 8; fewer if the device has not that many. 1: the
    // center alone, all or nothing. Throws as the constructor does.
    void setSamples(int samples);
    // The sample count in use.
    int samples() const { return mSamples; }

    // Binds materials to parts from the next record() on; the default appearance until then. Nothing waits:
    // the change travels with the commands.
    void setAppearance(const Appearance& appearance);

    // From the next record() on every part shows the first `terms` of its K only; 0 or K and more: all.
    void setTerms(int terms) { mTerms = terms; }
    // Adds the residual from the next record() on, where the relighter has one; on by default.
    void setResidual(bool isAdded) { mAddsResidual = isAdded; }
    // Fades the ground from the next record() on; none draws all of it. Radiance is premultiplied by the
    // coverage, which is alpha.
    void setGroundFade(const std::optional<GroundFade>& fade) { mGroundFade = fade; }
    // From the next record() on.
    void setInspect(Inspect inspect) { mInspect = inspect; }

    // Pass "view": draws the asset with the tuples recorded before.
    void record(vk::Commands& commands, const Camera& camera, const Relighter& relighter);

    // RGBA32F, linear, premultiplied by alpha: the share of a pixel's samples that are covered. In
    // TRANSFER_SRC_OPTIMAL after record(). It can be sampled as well.
    const vk::Image& image() const { return mColor; }
    // Depth of the first sample of every pixel, by the camera's clipFromWorld() with the asset's bounds, 1
    // where nothing is seen; with a stencil that means nothing to others. It is in
    // DEPTH_STENCIL_ATTACHMENT_OPTIMAL after record(), can be copied from, and is to be left in that layout.
    const vk::Image& depth() const { return mSamples > 1 ? mPixelDepth : mDepth; }

    // The image of the last submission. Waits for the device.
    Image read() const;

    // One submission of record(), read back.
    Image render(const Camera& camera, const Relighter& relighter);

  private:
    struct Set {
        uint32_t terms = 0, materials = 0;
        DiskMapping mapping = DiskMapping::Orthographic;
        ViewMapTexture viewMaps;
        bool hasTangents = false; // which frames follow
        // Of the tuples, as the shader reads them: four where no vertex begins amid a texel.
        uint32_t floatsPerTexel() const { return terms % 4 == 0 ? 4 : 1; }
    };
    struct Part {
        Bounds bounds;
        bool isClosed = false;
        vk::Buffer drawnPositions, drawnTriangles; // NumberedTriangles
        vk::Buffer vertices, triangles;            // shared::ViewVertex and corners, looked up by pixels
        TriangleClusters clusters;
        uint32_t firstSurface = 0, surfaces = 0; // triangles, numbered over all parts from 1 on
        uint32_t paint = 0;                      // how it is painted where it is
        vk::Image baseColor, materialMap, normalMap, emissionMap;
        shared::ViewDetail detail;
        bool isDetailed; // by detail
        std::vector<Set> sets;
        vk::Buffer layers; // shared::ViewDetail, and shared::ViewLayer, as many as can be bound
        PartAppearance bound;
        uint32_t look = 0; // what that asks of the shader
        std::vector<shared::ViewLayer> boundLayers;
    };
    // A camera, for an image of a size.
    struct Frame {
        mat4 clipFromWorld;
        vec3 eye;
        vec3 corner, right, down; // shared::ViewRays
        vec2 pixel;               // its size in clip space
        bool operator==(const Frame&) const = default;
    };

    Part makePart(const AssetPart& source, uint32_t firstSurface);
    Set makeSet(const MaterialSet& source, const std::string& name);
    static const Set& boundSet(const Part& part) { return part.sets[part.bound.set]; }
    // The pixels that a program shades: All with one sample a pixel; with several, Inner ones are shaded once
    // and Edges once per group of samples.
    enum class Pixels { All, Inner, Edges };
    // A shading tells a program what it shades, and how. `look`: shared::kSingleLook and so on; `estimate`:
    // shared::kTermsAlone and so on; `harmonics`: of the bound layers' lit spheres, at most.
    struct Shading {
        uint32_t look;
        bool allTerms;
        uint32_t estimate, harmonics;
        Pixels pixels;
    };
    // The stencil value of a part's pixels. Parts that share a value are told apart by triangle id. With
    // several samples the highest bit marks edges.
    uint32_t stencilOf(const Part& part) const {
        return uint32_t(&part - mParts.data()) % (mSamples == 1 ? 255 : 127) + 1;
    }
    void makeImages(int width, int height);
    void makePrograms();
    Frame frameOf(const Camera& camera) const;
    void drawSurfaces(vk::Commands& commands, const Frame& frame, const Part& part) const;
    void recordSurfaces(vk::Commands& commands, const Frame& frame) const;
    // Marks the pixels that are shaded more than once in the stencil.
    void markEdges(vk::Commands& commands, const Frame& frame) const;
    void shade(vk::Commands& commands, const Frame& frame, size_t part, const Relighter& relighter,
               Pixels pixels);
    // Returns shared::kTermsAlone and so on.
    uint32_t estimateOf(const ResidualSet* residual) const;
    // Null if the part shows the K terms alone with this set bound.
    const ResidualSet* residualOf(size_t part, size_t set, const Relighter& relighter) const;
    // Makes the lit spheres that the bound layers of all parts need.
    void recordSpheres(vk::Commands& commands, const Frame& frame, const Relighter& relighter);
    void inspect(vk::Commands& commands, const Frame& frame, const Part& part);
    // None: it is not seen.
    static std::optional<shared::ViewRays> raysOf(const Frame& frame, const Bounds& bounds);
    const vk::GraphicsProgram& shadeProgram(const Set& set, const Shading& shading);
    // Makes the programs of all sets and looks ahead of their use, so that no swap of materials waits.
    void makeShadePrograms(const Relighter& relighter);

    const vk::Device& mDevice;
    const Asset& mAsset;
    Bounds mBounds;
    VkFormat mDepthFormat;
    int mSamples = 1;
    struct SamplePrograms {
        vk::GraphicsProgram surfaces, closedSurfaces;
        vk::GraphicsProgram edges;   // of several samples only
        vk::GraphicsProgram inspect; // made when it is first asked for
    };
    std::map<int, SamplePrograms> mPrograms;                     // by samples
    std::map<vk::Constants, vk::GraphicsProgram> mShadePrograms; // by the constants of view_shade.frag
    vk::Sampler mPixelSampler;
    vk::Sampler mDiskSampler, mPolarSampler, mSurfaceSampler; // the latter two wrap: in x, and all around
    std::vector<Part> mParts;
    int mTerms = 0;
    bool mIsUnshadowed;
    bool mAddsResidual = true, mHasShadePrograms = false;
    std::optional<GroundFade> mGroundFade;
    Inspect mInspect = Inspect::Off;
    float mMedianArea = 0;
    vk::Image mColor, mSurfaces, mDepth;
    vk::Image mPixelDepth; // of several samples: what the first ones hold
    // What the images but mColor hold; none until it is recorded.
    std::optional<Frame> mDrawn;
    bool mHasMarkedEdges = false; // in the stencil of mDrawn
};

} // namespace relume
