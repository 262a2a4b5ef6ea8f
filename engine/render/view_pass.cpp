#include "engine/render/view_pass.h"

#include "engine/base/check.h"
#include "engine/render/view_grid.h"
#include "engine/render/view_image.h"
#include "engine/scene/camera.h"
#include "shaders/view_edges_frag.h"
#include "shaders/view_inspect_frag.h"
#include "shaders/view_inspect_samples_frag.h"
#include "shaders/view_shade_vert.h"
#include "shaders/view_triangle_id_frag.h"
#include "shaders/view_triangle_id_vert.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace relume {

using vk::Stage;

namespace {

float pixelFraction(const vk::Device& device) {
    return std::exp2(-float(device.limits().subPixelPrecisionBits));
}

// Returns the most harmonics of any layer's lit spheres; 0 if there are none.
uint32_t mostHarmonics(const ResidualSet* residual) {
    int most = 0;
    if (residual)
        for (const auto& layer : residual->layers) most = std::max(most, layer->harmonics);
    return uint32_t(most);
}

// Returns the numbers of harmonics that bindings of the set need of programs of this look.
std::set<uint32_t> harmonicsOf(const MaterialSet& set, const ResidualSet* residual, uint32_t look) {
    if (!residual || look != shared::kSingleLook) return {mostHarmonics(residual)};
    std::set<uint32_t> harmonics;
    for (const AssetMaterial& material : set.materials)
        if (!material.hasBase)
            harmonics.insert(uint32_t(residual->layers[size_t(material.layer)]->harmonics));
    return harmonics;
}

uint32_t boundHarmonics(const ViewPart& part, const ResidualSet* residual) {
    if (!residual || part.look != shared::kSingleLook) return mostHarmonics(residual);
    const size_t layer = part.boundLayers[0].firstMap / part.boundSet().viewMaps.imagesPerLayer;
    return uint32_t(residual->layers[layer]->harmonics);
}

float medianAreaOf(const Asset& asset) {
    std::vector<float> areas;
    for (const AssetPart& part : asset.parts)
        for (const uvec3& t : part.mesh.triangles) {
            const std::vector<vec3>& p = part.mesh.positions;
            areas.push_back(0.5f * glm::length(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x])));
        }
    if (areas.empty()) return 0;
    const auto middle = areas.begin() + std::ptrdiff_t(areas.size() / 2);
    std::nth_element(areas.begin(), middle, areas.end());
    return *middle;
}

} // namespace

ViewPass::ViewPass(const vk::Device& device, const Asset& asset, const ViewOptions& options)
    : mDevice(device), mAsset(asset), mBounds(boundsOf(asset)), mDepthFormat(viewDepthFormat(device)),
      mShadePrograms(device, mDepthFormat), mIsUnshadowed(options.isUnshadowed),
      mPreparesAllMaterials(options.preparesAllMaterials) {
    constexpr VkSamplerAddressMode kClamp = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    mPixelSampler = {device, kClamp, kClamp, "triangle ids", VK_FILTER_NEAREST};
    mDiskSampler = {device, kClamp, kClamp, "view maps"};
    mPolarSampler = {device, VK_SAMPLER_ADDRESS_MODE_REPEAT, kClamp, "polar view maps"};
    mSurfaceSampler = {device, VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_REPEAT,
                       "surface textures"};
    uint32_t firstTriangleId = 1;
    for (const AssetPart& part : asset.parts) {
        mParts.emplace_back(device, part, firstTriangleId);
        firstTriangleId += mParts.back().triangleCount;
    }
    setAppearance(defaultAppearance(asset));
    mSamples = supportedViewSamples(device, mDepthFormat, options.samples);
    makePrograms();
    makeImages(options.width, options.height);
}

void ViewPass::setSamples(int samples) {
    const int supported = supportedViewSamples(mDevice, mDepthFormat, samples);
    if (supported == mSamples) return;
    mSamples = supported;
    mHasShadePrograms = false;
    makePrograms();
    makeImages(int(mColor.options().width), int(mColor.options().height));
}

void ViewPass::makePrograms() {
    SamplePrograms& programs = mPrograms[mSamples];
    if (programs.triangleIds.pipeline()) return;
    vk::GraphicsOptions options{.colorFormat = kTriangleIdFormat, .depthFormat = mDepthFormat};
    options.stencil = vk::Stencil::Write;
    options.readsPositions = true;
    options.samples = uint32_t(mSamples);
    programs.triangleIds = {
        mDevice, view_triangle_id_vert_spirv, view_triangle_id_frag_spirv, {}, options, "triangle ids"};
    options.cull = vk::Cull::Clockwise;
    programs.closedTriangleIds = {mDevice, view_triangle_id_vert_spirv, view_triangle_id_frag_spirv, {},
                                  options, "closed triangle ids"};
    if (mSamples == 1) return;
    vk::GraphicsOptions edges = shadeOptions(mDepthFormat, kEdgeBit - 1);
    edges.stencil = vk::Stencil::Replace;
    edges.stencilWritten = kEdgeBit;
    edges.writesColor = false;
    // Constants are numbered as in lib/pixel_samples.glsl.
    programs.edges = {
        mDevice, view_shade_vert_spirv, view_edges_frag_spirv, {0, 0, 0, 0, 0, uint32_t(mSamples)},
        edges,   "view edges"};
}

void ViewPass::makeShadePrograms(const Relighter& relighter) {
    std::vector<ShadeVariant> variants;
    const auto add = [&](size_t p, size_t s, uint32_t look, const ResidualSet* residual, uint32_t harmonics) {
        for (const ShadedPixels pixels : {ShadedPixels::All, ShadedPixels::Inner, ShadedPixels::Edges})
            if ((pixels == ShadedPixels::All) == (mSamples == 1))
                variants.push_back(variantOf(p, mParts[p].sets[s], look, usesAllTerms(mParts[p].sets[s]),
                                             residual, harmonics, pixels));
    };
    for (size_t p = 0; p < mParts.size(); p++) {
        const ViewPart& part = mParts[p];
        if (part.triangleCount == 0) continue;
        if (!mPreparesAllMaterials) {
            const ResidualSet* residual = residualOf(p, part.bound.set, relighter);
            add(p, part.bound.set, part.look, residual, boundHarmonics(part, residual));
            continue;
        }
        for (size_t s = 0; s < part.sets.size(); s++) {
            const ResidualSet* residual = residualOf(p, s, relighter);
            const MaterialSet& source = mAsset.parts[p].sets[s];
            for (const uint32_t look : looksOf(mAsset.parts[p], source))
                for (const uint32_t harmonics : harmonicsOf(source, residual, look))
                    add(p, s, look, residual, harmonics);
        }
    }
    mShadePrograms.make(variants);
}

void ViewPass::setAppearance(const Appearance& appearance) {
    RELUME_CHECK_EQ(appearance.size(), mParts.size());
    for (size_t i = 0; i < mParts.size(); i++) mParts[i].bind(mAsset.parts[i], appearance[i]);
    if (!mPreparesAllMaterials) mHasShadePrograms = false;
}

void ViewPass::resize(int width, int height) {
    RELUME_CHECK(width > 0 && height > 0);
    makeImages(width, height);
}

void ViewPass::makeImages(int width, int height) {
    vk::ImageOptions options{
        .format = kViewColorFormat, .width = uint32_t(width), .height = uint32_t(height)};
    options.usage =
        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    mColor = vk::Image(mDevice, options, "view color");
    options.samples = uint32_t(mSamples);
    options.format = kTriangleIdFormat;
    options.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    mTriangleIds = vk::Image(mDevice, options, "triangle ids");
    options.format = mDepthFormat;
    options.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    mDepth = vk::Image(mDevice, options, "view depth");
    mPixelDepth = {};
    mDrawn.reset();
    options.samples = 1;
    if (mSamples > 1) mPixelDepth = vk::Image(mDevice, options, "view depth of pixels");
}

ViewPass::Frame ViewPass::frameOf(const Camera& camera) const {
    const auto width = int(mColor.options().width), height = int(mColor.options().height);
    const vec3 forward = glm::normalize(camera.target - camera.eye);
    // Use directions at unit depth, which are linear in x and y.
    const auto center = [&](int x, int y) {
        const vec3 direction = camera.pixelDirection(x, y, width, height);
        return direction / glm::dot(direction, forward);
    };
    Frame frame;
    frame.clipFromWorld = camera.clipFromWorld(float(width) / float(height), mBounds);
    frame.eye = camera.eye;
    frame.right = (center(width, 0) - center(0, 0)) / float(width);
    frame.down = (center(0, height) - center(0, 0)) / float(height);
    frame.corner = center(0, 0) - 0.5f * (frame.right + frame.down);
    frame.pixel = vec2(2 / float(width), 2 / float(height));
    return frame;
}

void ViewPass::drawTriangleIds(vk::Commands& commands, const Frame& frame, const ViewPart& part) const {
    if (part.triangleCount == 0) return;
    if (mGroundFade && mGroundFade->isHiddenFrom(frame.eye) && &part == &mParts[mGroundFade->part]) return;
    const bool showsNoBack = part.isClosed && screenBox(part.bounds, frame.clipFromWorld).isBeyondNear;
    const SamplePrograms& programs = mPrograms.at(mSamples);
    commands.bind(showsNoBack ? programs.closedTriangleIds : programs.triangleIds, {},
                  shared::ViewTriangleIdPush{frame.clipFromWorld, part.firstTriangleId});
    commands.setPositions(part.drawnPositions);
    commands.setStencil(stencilOf(part));
    const float focalLength = 1 / glm::length(frame.right);
    for (const TriangleRun& run : part.clusters.visible(
             {frame.clipFromWorld, frame.eye, focalLength, pixelFraction(mDevice), showsNoBack}))
        commands.drawIndexed(part.drawnTriangles, 3 * run.count, 1, 3 * run.first);
}

std::optional<shared::ViewRays> ViewPass::raysOf(const Frame& frame, const Bounds& bounds) {
    const ScreenBox box = screenBox(bounds, frame.clipFromWorld);
    const vec2 low = glm::max(box.low - frame.pixel, vec2(-1)),
               high = glm::min(box.high + frame.pixel, vec2(1));
    if (low.x >= high.x || low.y >= high.y) return std::nullopt;
    return shared::ViewRays{frame.eye, frame.corner, frame.right, frame.down,
                            vec4(low.x, low.y, high.x, high.y)};
}

void ViewPass::inspect(vk::Commands& commands, const Frame& frame, const ViewPart& part) {
    static_assert(uint32_t(Inspect::Wireframe) == shared::kInspectWireframe &&
                  uint32_t(Inspect::Normals) == shared::kInspectNormals &&
                  uint32_t(Inspect::Density) == shared::kInspectDensity);
    const std::optional<shared::ViewRays> rays = raysOf(frame, part.bounds);
    if (!rays || part.triangleCount == 0) return;
    vk::GraphicsProgram& program = mPrograms.at(mSamples).inspect;
    if (!program.pipeline()) {
        vk::GraphicsOptions options = shadeOptions(mDepthFormat);
        if (mSamples > 1) options.stencil = vk::Stencil::None, options.addsColor = true;
        if (mSamples > 1)
            program = {mDevice,
                       view_shade_vert_spirv,
                       view_inspect_samples_frag_spirv,
                       {0, 0, 0, 0, 0, uint32_t(mSamples)},
                       options,
                       "inspect samples"};
        else
            program = {mDevice, view_shade_vert_spirv, view_inspect_frag_spirv, {}, options, "inspect"};
        mMedianArea = medianAreaOf(mAsset);
    }
    commands.bind(program,
                  {{mTriangleIds, mPixelSampler},
                   vk::Binding::texelsOf(part.triangles, VK_FORMAT_R32G32B32A32_UINT),
                   vk::Binding::texelsOf(part.vertices, VK_FORMAT_R32G32B32A32_SFLOAT)},
                  shared::ViewInspectPush{*rays, part.firstTriangleId, part.triangleCount, uint32_t(mInspect),
                                          mMedianArea});
    if (mSamples == 1) commands.setStencil(stencilOf(part));
    commands.draw(6);
}

void ViewPass::markEdges(vk::Commands& commands, const Frame& frame) const {
    const vk::GraphicsProgram& program = mPrograms.at(mSamples).edges;
    // Marks edges among the pixels whose first sample has this stencil value.
    const auto mark = [&](const ViewPart& part, const Bounds& bounds, uint32_t stencil) {
        const std::optional<shared::ViewRays> rays = raysOf(frame, bounds);
        if (!rays || part.triangleCount == 0) return;
        commands.bind(program,
                      {{mTriangleIds, mPixelSampler},
                       vk::Binding::texelsOf(part.triangles, VK_FORMAT_R32G32B32A32_UINT)},
                      shared::ViewEdgesPush{*rays, part.firstTriangleId, part.triangleCount});
        commands.setStencil(stencil | kEdgeBit);
        commands.draw(6);
    };
    for (const ViewPart& part : mParts) mark(part, part.bounds, stencilOf(part));
    // Test pixels whose first sample is empty once, with the data of any part.
    const auto any =
        std::ranges::find_if(mParts, [](const ViewPart& part) { return part.triangleCount > 0; });
    if (any != mParts.end()) mark(*any, mBounds, 0);
}

uint32_t ViewPass::estimateOf(size_t part, const ViewSet& set, const ResidualSet* residual) const {
    const bool isShadow = mGroundFade && mGroundFade->part == part && mGroundFade->isShadow;
    const uint32_t shadow = isShadow ? shared::kShadow : 0;
    if (!residual) return shared::kTermsAlone + shadow;
    if (mIsUnshadowed) return shared::kUnshadowed + shadow;
    const bool isRatio = residual->hasNonnegativeTerms, tellsDirect = isRatio && set.directShares.bytes() > 0;
    return (isRatio ? shared::kResidualRatio : shared::kResidualDifference) +
           (residual->isBounced ? shared::kBounced : 0) + (tellsDirect ? shared::kDirectShares : 0) + shadow;
}

ShadeVariant ViewPass::variantOf(size_t part, const ViewSet& set, uint32_t look, bool allTerms,
                                 const ResidualSet* residual, uint32_t harmonics, ShadedPixels pixels) const {
    return {.terms = set.terms,
            .isGray = set.viewMaps.isGray,
            .look = look,
            .allTerms = allTerms,
            .estimate = estimateOf(part, set, residual),
            .samples = uint32_t(mSamples),
            .pixels = pixels,
            .harmonics = harmonics,
            .hasTangents = set.hasTangents};
}

const ResidualSet* ViewPass::residualOf(size_t part, size_t set, const Relighter& relighter) const {
    return mAddsResidual ? relighter.spheres().set(part, set) : nullptr;
}

void ViewPass::recordSpheres(vk::Commands& commands, const Frame& frame, const Relighter& relighter) {
    std::set<uint32_t> kernels, nodes;
    for (size_t i = 0; i < mParts.size(); i++) {
        ViewPart& part = mParts[i];
        const ResidualSet* residual = residualOf(i, part.bound.set, relighter);
        const std::optional<shared::ViewRays> rays = raysOf(frame, part.bounds);
        if (!residual || !rays || part.triangleCount == 0 || part.boundLayers.empty()) continue;
        const vec2 size(float(mColor.options().width), float(mColor.options().height));
        const vec4 rectangle = 0.5f * (rays->rectangle + 1.0f) * vec4(size, size);
        addGridNodes(nodes, rays->corner, rays->right, rays->down, vec2(rectangle),
                     {rectangle.z, rectangle.w});
        for (shared::ViewLayer& layer : part.boundLayers) {
            const size_t number = layer.firstMap / part.boundSet().viewMaps.imagesPerLayer;
            const uint32_t kernel = relighter.spheres().kernel(residual->layers[number].get());
            layer.firstSlot = kernel * shared::kGridNodes;
            layer.harmonics = uint32_t(residual->layers[number]->harmonics);
            layer.mostOfFlat = part.isDetailed ? concentrationOf(*residual->layers[number]) : 1;
            kernels.insert(kernel);
        }
    }
    if (!kernels.empty())
        relighter.spheres().record(commands, std::vector(kernels.begin(), kernels.end()), nodes,
                                   !mIsUnshadowed);
}

void ViewPass::shade(vk::Commands& commands, const Frame& frame, size_t number, const Relighter& relighter,
                     ShadedPixels pixels) {
    const ViewPart& part = mParts[number];
    const ViewSet& set = part.boundSet();
    const LitSpheres& spheres = relighter.spheres();
    const ResidualSet* residual = residualOf(number, part.bound.set, relighter);
    const auto tuplesOf = [](const vk::Buffer& tuples) {
        return vk::Binding::texelsOf(tuples, VK_FORMAT_R32G32B32A32_SFLOAT);
    };
    const std::optional<shared::ViewRays> rays = raysOf(frame, part.bounds);
    if (!rays || part.triangleCount == 0) return;
    const bool usesAll = usesAllTerms(set);
    const bool isSingle = part.look == shared::kSingleLook;
    const bool fades = mGroundFade && mGroundFade->part == number;
    const uint32_t firstTuples = spheres.firstTuples(number, part.bound.set).value_or(0);
    const shared::ViewShadePush push{*rays,
                                     part.firstTriangleId,
                                     part.triangleCount,
                                     uint32_t(set.mapping),
                                     isSingle ? part.boundLayers[0].firstMap : 0,
                                     isSingle ? part.boundLayers[0].weight : 0,
                                     uint32_t(part.boundLayers.size()),
                                     part.bound.painted ? part.paint : shared::kUnpainted,
                                     set.materials,
                                     usesAll ? set.terms : uint32_t(mTerms),
                                     isSingle ? part.boundLayers[0].firstSlot : 0,
                                     firstTuples,
                                     spheres.fillSlots(),
                                     fades ? vec4(mGroundFade->center, mGroundFade->inner, mGroundFade->outer)
                                           : vec4(0)};
    commands.bind(mShadePrograms.get(variantOf(number, set, part.look, usesAll, residual,
                                               boundHarmonics(part, residual), pixels)),
                  {{mTriangleIds, mPixelSampler},
                   vk::Binding::texelsOf(part.triangles, VK_FORMAT_R32G32B32A32_UINT),
                   vk::Binding::texelsOf(part.vertices, VK_FORMAT_R32G32B32A32_SFLOAT),
                   tuplesOf(relighter.tuples(number, part.bound.set)),
                   {set.viewMaps.image, isPolar(set.mapping) ? mPolarSampler : mDiskSampler},
                   part.layers,
                   {part.baseColor, mSurfaceSampler},
                   {part.materialMap, mSurfaceSampler},
                   {spheres.image(), mPolarSampler},
                   vk::Binding::texelsOf(spheres.slots(), VK_FORMAT_R32_UINT),
                   vk::Binding::texelsOf(spheres.grid(), VK_FORMAT_R32G32B32A32_SFLOAT),
                   {spheres.tuples(), mPolarSampler},
                   vk::Binding::texelsOf(spheres.weights(), VK_FORMAT_R32G32B32A32_SFLOAT),
                   {part.normalMap, mSurfaceSampler},
                   {part.emissionMap, mSurfaceSampler},
                   tuplesOf(relighter.fillTuples(number, part.bound.set)),
                   // Without shares the shader reads nothing here, but something must be bound.
                   vk::Binding::texelsOf(set.directShares.bytes() > 0 ? set.directShares : spheres.slots(),
                                         VK_FORMAT_R32_UINT)},
                  push);
    commands.setStencil(pixels == ShadedPixels::Edges ? kEdgeBit : stencilOf(part));
    commands.draw(6);
}

void ViewPass::recordTriangleIds(vk::Commands& commands, const Frame& frame) const {
    commands.transition(mTriangleIds, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                        Stage::Draw, Stage::Color);
    const vk::Image* const firstSamples = mSamples > 1 ? &mPixelDepth : nullptr;
    for (const vk::Image* depth : {&mDepth, firstSamples})
        if (depth)
            commands.transition(*depth, VK_IMAGE_LAYOUT_UNDEFINED,
                                VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, Stage::Color, Stage::Color);
    // Resolving depth counts as writing a color attachment, which is no access of the image's layout.
    if (firstSamples) commands.barrier(Stage::Color, Stage::Color);
    commands.render({.color = &mTriangleIds, .depth = &mDepth, .firstSamples = firstSamples}, [&] {
        for (const ViewPart& part : mParts) drawTriangleIds(commands, frame, part);
    });
    commands.transition(mTriangleIds, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, Stage::Color, Stage::Draw);
}

void ViewPass::record(vk::Commands& commands, const Camera& camera, const Relighter& relighter) {
    RELUME_CHECK_EQ(relighter.parts(), mParts.size());
    const Frame frame = frameOf(camera);
    if (!std::exchange(mHasShadePrograms, true)) makeShadePrograms(relighter);
    if (mInspect == Inspect::Off) recordSpheres(commands, frame, relighter);
    commands.barrier(Stage::Draw, Stage::Transfer); // an earlier frame may still be reading the layers
    for (const ViewPart& part : mParts)
        if (!part.boundLayers.empty()) {
            const auto detail = std::as_bytes(std::span(&part.detail, 1));
            const auto layers = std::as_bytes(std::span(part.boundLayers));
            std::vector<std::byte> bytes(detail.begin(), detail.end());
            bytes.insert(bytes.end(), layers.begin(), layers.end());
            commands.update(part.layers, bytes);
        }
    commands.barrier(Stage::Transfer, Stage::Draw);
    commands.pass("view", [&] {
        if (mDrawn != frame) {
            recordTriangleIds(commands, frame);
            mDrawn = frame;
            mHasMarkedEdges = false;
        }
        commands.transition(mColor, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                            Stage::Transfer, Stage::Color);
        commands.barrier(Stage::Color, Stage::Color);
        const auto shadeAll = [&](ShadedPixels pixels) {
            for (size_t i = 0; i < mParts.size(); i++) shade(commands, frame, i, relighter, pixels);
        };
        commands.render({.color = &mColor, .depth = &depth(), .keepsDepth = true}, [&] {
            if (mInspect != Inspect::Off) {
                for (const ViewPart& part : mParts) inspect(commands, frame, part);
            } else if (mSamples == 1) {
                shadeAll(ShadedPixels::All);
            } else {
                if (!std::exchange(mHasMarkedEdges, true)) markEdges(commands, frame);
                shadeAll(ShadedPixels::Inner);
                shadeAll(ShadedPixels::Edges);
            }
        });
        commands.transition(mColor, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                            VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, Stage::Color, Stage::Transfer);
    });
}

Image ViewPass::read() const { return downloadImage(mDevice, mColor); }

Image ViewPass::render(const Camera& camera, const Relighter& relighter) {
    vk::Commands commands(mDevice, "view");
    commands.begin();
    record(commands, camera, relighter);
    commands.submitAndWait();
    return read();
}

} // namespace relume
