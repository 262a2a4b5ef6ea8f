// View change: draws every part with its light-modulated tuples and view maps into a linear float image.
// Touches no transport. First it draws which triangle every pixel sees, then it shades pixels, each once:
// docs/view_speed.md says why.
#pragma once

#include "engine/image/image.h"
#include "engine/render/appearance.h"
#include "engine/render/map_texture.h"
#include "engine/render/relighter.h"
#include "engine/render/triangle_clusters.h"
#include "engine/scene/camera.h"
#include "shaders/shared/render.h"

namespace relume {

struct ViewOptions {
    int width = 640, height = 480;
};

// What an image shows instead of radiance: triangles' edges; normals, as normal maps are coloured; how much
// smaller (red) or larger (blue) triangles are than the asset's median.
enum class Inspect { Off, Wireframe, Normals, Density };

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

    // From the next record() on every part shows the first `terms` of its K only; 0 or K and more: all.
    void setTerms(int terms) { mTerms = terms; }
    // From the next record() on what K terms leave of BRDFs is added, where the relighter has residuals; as
    // it is at first. Or it is not.
    void setResidual(bool isAdded) { mAddsResidual = isAdded; }
    // From the next record() on.
    void setInspect(Inspect inspect) { mInspect = inspect; }

    // Pass "view": draws the asset with the tuples recorded before.
    void record(vk::Commands& commands, const Camera& camera, const Relighter& relighter);

    // RGBA32F, linear, alpha 1 where covered, 0 elsewhere; in TRANSFER_SRC_OPTIMAL after record(). It can be
    // sampled as well.
    const vk::Image& image() const { return mColor; }

    // The image of the last submission. Waits for the device.
    Image read() const;

    // One submission of record(), read back.
    Image render(const Camera& camera, const Relighter& relighter);

  private:
    struct Set {
        uint32_t terms = 0, materials = 0;
        DiskMapping mapping = DiskMapping::Orthographic;
        ViewMapTexture viewMaps;
        std::array<const vk::GraphicsProgram*, 3> programs; // by look; made ahead, so that no swap waits
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
        vk::Image baseColor, materialMap;
        std::vector<Set> sets;
        vk::Buffer layers; // shared::ViewLayer, as many as can be worn
        PartAppearance worn;
        uint32_t look = 0; // what that asks of the shader
        std::vector<shared::ViewLayer> wornLayers;
    };
    // A camera, for an image of a size.
    struct Frame {
        mat4 clipFromWorld;
        vec3 eye;
        vec3 corner, right, down; // shared::ViewRays
        vec2 pixel;               // its size in clip space
    };

    Part makePart(const AssetPart& source, uint32_t firstSurface);
    Set makeSet(const MaterialSet& source, const std::string& name);
    static const Set& wornSet(const Part& part) { return part.sets[part.worn.set]; }
    // Where it was drawn is where it may be shaded; parts that share a value sort it out by surface.
    uint32_t stencilOf(const Part& part) const { return uint32_t(&part - mParts.data()) % 255 + 1; }
    Frame frameOf(const Camera& camera) const;
    void drawSurfaces(vk::Commands& commands, const Frame& frame, const Part& part) const;
    void shade(vk::Commands& commands, const Frame& frame, const Part& part, const Relighter& relighter);
    // Null: the part shows its terms alone.
    const ResidualSet* residualOf(const Part& part, const Relighter& relighter) const;
    // Makes the lit spheres that the worn layers of all parts need.
    void recordSpheres(vk::Commands& commands, const Frame& frame, const Relighter& relighter);
    void inspect(vk::Commands& commands, const Frame& frame, const Part& part);
    // None: it is not seen.
    static std::optional<shared::ViewRays> raysOf(const Frame& frame, const Part& part);
    // `look`: shared::kSingleLook and so on.
    const vk::GraphicsProgram& shadeProgram(uint32_t terms, bool grey, uint32_t look, bool allTerms = true,
                                            uint32_t estimate = shared::kTermsAlone);

    const vk::Device& mDevice;
    const Asset& mAsset;
    Bounds mBounds;
    VkFormat mDepthFormat;
    vk::GraphicsProgram mSurfaceProgram, mClosedSurfaceProgram;
    std::map<std::array<uint32_t, 5>, vk::GraphicsProgram> mShadePrograms; // by shadeProgram()'s arguments
    vk::GraphicsProgram mInspectProgram;                                   // made when it is first asked for
    vk::Sampler mPixelSampler;
    vk::Sampler mDiskSampler, mPolarSampler, mSurfaceSampler; // the latter two wrap: in x, and all around
    std::vector<Part> mParts;
    int mTerms = 0;
    bool mAddsResidual = true;
    Inspect mInspect = Inspect::Off;
    float mMedianArea = 0;
    vk::Image mColor, mSurfaces, mDepth;
};

} // namespace relume
