// View change: draws every part into a linear float image from its tuples and view maps, without touching
// transport. First it draws a visibility buffer, the triangle id of every sample of every pixel. Then it
// shades: a pixel once if its samples see one smooth surface, else once per surface. The visibility buffer is
// kept while the camera stays, so that a new light needs only the shading. docs/view_speed.md says why.
#pragma once

#include "engine/image/image.h"
#include "engine/render/ground_fade.h"
#include "engine/render/pixel_samples.h"
#include "engine/render/relighter.h"
#include "engine/render/shade_programs.h"
#include "engine/render/view_part.h"
#include "engine/scene/camera.h"
#include "shaders/shared/render.h"

namespace relume {

struct ViewOptions {
    int width = 640, height = 480;
    int samples = kDefaultSamples; // see setSamples()
    // Draws parts with a residual as if nothing shadowed them, whatever their transport.
    bool isUnshadowed = false;
    // Makes the programs of all materials before the first image, so that no swap waits for its own.
    // Otherwise each is made when it is first drawn.
    bool preparesAllMaterials = false;
};

// What an image shows instead of radiance: edges of triangles; normals, colored as in normal maps; or
// triangle sizes, smaller (red) or larger (blue) than the asset's median.
enum class Inspect { Off, Wireframe, Normals, Density };

// Draws views of an asset. Keeps references to device and asset, which must outlive it.
class ViewPass {
  public:
    // Uploads meshes, view maps and textures. Throws OutOfMemory, or Error if a part has more vertices than
    // the device can bind, or the image is larger than it can make.
    ViewPass(const vk::Device& device, const Asset& asset, const ViewOptions& options = {});

    // Sets the image size; discards what was drawn.
    void resize(int width, int height);

    // Sets the samples per pixel from the next record() on: 1, 2, 4 or 8; fewer if the device does not
    // support as many. With 1, coverage is decided at the pixel's center. Throws as the constructor does.
    void setSamples(int samples);
    // Returns the sample count in use.
    int samples() const { return mSamples; }

    // Binds materials to parts from the next record() on; until then the default appearance is bound. Does
    // not wait: the change travels with the commands. The next record() makes programs that are missing.
    void setAppearance(const Appearance& appearance);

    // Draws the first `terms` of K terms only, from the next record() on; 0, or K and more, draws all.
    void setTerms(int terms) { mTerms = terms; }
    // Adds the residual from the next record() on, where the relighter has one; on by default.
    void setResidual(bool isAdded) { mAddsResidual = isAdded; }
    // Fades the ground, or draws its shadow alone, from the next record() on; without a fade all of it is
    // drawn. Radiance is premultiplied by the coverage, which is alpha.
    void setGroundFade(const std::optional<GroundFade>& fade) {
        if (bool(fade) != bool(mGroundFade) || (fade && fade->isShadow != mGroundFade->isShadow))
            mDrawn.reset();
        mGroundFade = fade;
    }
    // Sets what images show from the next record() on.
    void setInspect(Inspect inspect) { mInspect = inspect; }

    // Records pass "view": draws the asset with the tuples recorded before.
    void record(vk::Commands& commands, const Camera& camera, const Relighter& relighter);

    // Returns the image: RGBA32F, linear, premultiplied by alpha, the share of a pixel's samples that are
    // covered. It is in TRANSFER_SRC_OPTIMAL after record(), and can be sampled.
    const vk::Image& image() const { return mColor; }
    // Returns the depth of the first sample of every pixel, by the camera's clipFromWorld() with the asset's
    // bounds; 1 where nothing is seen. Its stencil is for internal use. It is in
    // DEPTH_STENCIL_ATTACHMENT_OPTIMAL after record(), can be copied from, and must be left in that layout.
    const vk::Image& depth() const { return mSamples > 1 ? mPixelDepth : mDepth; }

    // Returns the image of the last submission. Waits for the device.
    Image read() const;

    // Submits one record(), waits, and returns the image.
    Image render(const Camera& camera, const Relighter& relighter);

  private:
    // A camera, for an image of a given size.
    struct Frame {
        mat4 clipFromWorld;
        vec3 eye;
        vec3 corner, right, down; // shared::ViewRays
        vec2 pixel;               // its size in normalized device coordinates
        bool operator==(const Frame&) const = default;
    };

    // Returns the stencil value of a part's pixels. Parts that share a value are told apart by triangle id.
    // With several samples the highest bit marks edges.
    uint32_t stencilOf(const ViewPart& part) const {
        return uint32_t(&part - mParts.data()) % (mSamples == 1 ? 255 : 127) + 1;
    }
    void makeImages(int width, int height);
    void makePrograms();
    Frame frameOf(const Camera& camera) const;
    void drawTriangleIds(vk::Commands& commands, const Frame& frame, const ViewPart& part) const;
    void recordTriangleIds(vk::Commands& commands, const Frame& frame) const;
    // Marks the pixels that are shaded more than once in the stencil.
    void markEdges(vk::Commands& commands, const Frame& frame) const;
    void shade(vk::Commands& commands, const Frame& frame, size_t part, const Relighter& relighter,
               ShadedPixels pixels);
    // Returns shared::kTermsAlone and so on.
    uint32_t estimateOf(size_t part, const ViewSet& set, const ResidualSet* residual) const;
    bool usesAllTerms(const ViewSet& set) const { return mTerms <= 0 || uint32_t(mTerms) >= set.terms; }
    // Returns the program that shades pixels of a part with this set bound.
    ShadeVariant variantOf(size_t part, const ViewSet& set, uint32_t look, bool allTerms,
                           const ResidualSet* residual, uint32_t harmonics, ShadedPixels pixels) const;
    // Returns null if the part shows the K terms alone with this set bound.
    const ResidualSet* residualOf(size_t part, size_t set, const Relighter& relighter) const;
    // Makes the lit spheres that the bound layers of all parts need.
    void recordSpheres(vk::Commands& commands, const Frame& frame, const Relighter& relighter);
    void inspect(vk::Commands& commands, const Frame& frame, const ViewPart& part);
    // Returns none if the bounds are not seen.
    static std::optional<shared::ViewRays> raysOf(const Frame& frame, const Bounds& bounds);
    // Makes the programs of the bound materials, or of all, side by side.
    void makeShadePrograms(const Relighter& relighter);

    const vk::Device& mDevice;
    const Asset& mAsset;
    Bounds mBounds;
    VkFormat mDepthFormat;
    int mSamples = 1;
    struct SamplePrograms {
        vk::GraphicsProgram triangleIds, closedTriangleIds;
        vk::GraphicsProgram edges;   // with several samples only
        vk::GraphicsProgram inspect; // made when first needed
    };
    std::map<int, SamplePrograms> mPrograms; // by samples
    ShadePrograms mShadePrograms;
    vk::Sampler mPixelSampler;
    vk::Sampler mDiskSampler, mPolarSampler,
        mSurfaceSampler; // mPolarSampler repeats in x, mSurfaceSampler in x and y
    std::vector<ViewPart> mParts;
    int mTerms = 0;
    bool mIsUnshadowed, mPreparesAllMaterials;
    bool mAddsResidual = true, mHasShadePrograms = false;
    std::optional<GroundFade> mGroundFade;
    Inspect mInspect = Inspect::Off;
    float mMedianArea = 0;
    vk::Image mColor, mTriangleIds, mDepth;
    vk::Image mPixelDepth; // with several samples: the depth of the first ones
    // The frame whose visibility buffer and depth the images hold; none until one is recorded.
    std::optional<Frame> mDrawn;
    bool mHasMarkedEdges = false; // in the stencil, for mDrawn
};

} // namespace relume
