#include "engine/render/view_pass.h"

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/render/map_texture.h"
#include "engine/render/numbered_triangles.h"
#include "engine/render/view_grid.h"
#include "engine/render/view_image.h"
#include "engine/scene/camera.h"
#include "engine/scene/closed_mesh.h"
#include "engine/vk/upload.h"
#include "shaders/view_edges_frag.h"
#include "shaders/view_inspect_frag.h"
#include "shaders/view_inspect_samples_frag.h"
#include "shaders/view_shade_frag.h"
#include "shaders/view_shade_samples_frag.h"
#include "shaders/view_shade_vert.h"
#include "shaders/view_triangle_id_frag.h"
#include "shaders/view_triangle_id_vert.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/core.h>
#include <span>
#include <utility>

namespace relume {

using vk::Stage;

namespace {

constexpr uint32_t kEdgeBit = 0x80; // of the stencil: marks edges where pixels have several samples

float pixelFraction(const vk::Device& device) {
    return std::exp2(-float(device.limits().subPixelPrecisionBits));
}

// Throws unless the device can read `texels` of a buffer, each of 16 bytes.
void expectTexels(const vk::Device& device, uint64_t texels, const std::string& name) {
    const uint64_t most = device.mostTexels(sizeof(vec4));
    if (texels > most)
        throw Error(fmt::format(
            "{}: {} texels are needed, {} reads at most {} of a buffer; split the mesh into several parts",
            name, texels, device.name(), most));
}

// Returns options of passes that shade pixels whose stencil equals the part's value in these bits.
vk::GraphicsOptions shadeOptions(VkFormat depthFormat, uint32_t stencilBits = 0xff) {
    return {.colorFormat = kViewColorFormat,
            .depthFormat = depthFormat,
            .depthCompare = VK_COMPARE_OP_ALWAYS,
            .depthWrite = false,
            .stencil = vk::Stencil::Equal,
            .stencilCompared = stencilBits};
}

// Returns the most harmonics of any layer's lit spheres; 0 if there are none.
uint32_t mostHarmonics(const ResidualSet* residual) {
    int most = 0;
    if (residual)
        for (const auto& layer : residual->layers) most = std::max(most, layer->harmonics);
    return uint32_t(most);
}

template <typename T>
vk::Buffer uploadBindable(const vk::Device& device, const std::vector<T>& values, const std::string& name) {
    const uint64_t bytes = std::span(values).size_bytes();
    if (bytes > device.largestStorageBuffer())
        throw Error(
            fmt::format("{}: {} bytes are needed, {} binds at most {}; split the mesh into several parts",
                        name, bytes, device.name(), device.largestStorageBuffer()));
    return vk::upload<T>(device, values, name);
}

std::vector<shared::ViewVertex> verticesOf(const Mesh& mesh) {
    RELUME_CHECK_EQ(mesh.normals.size(), mesh.positions.size());
    std::vector<shared::ViewVertex> vertices;
    vertices.reserve(mesh.vertexCount());
    for (size_t v = 0; v < mesh.vertexCount(); v++)
        vertices.push_back({mesh.positions[v], mesh.normals[v], mesh.uvs.empty() ? vec2(0) : mesh.uvs[v],
                            mesh.colors.empty() ? vec4(0) : mesh.colors[v],
                            mesh.tangents.empty() ? vec3(0) : mesh.tangents[v], 0});
    return vertices;
}

std::vector<glm::u32vec4> cornersOf(const Mesh& mesh) {
    std::vector<glm::u32vec4> corners;
    corners.reserve(mesh.triangleCount());
    for (const uvec3& triangle : mesh.triangles) corners.emplace_back(triangle, 0);
    return corners;
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

shared::ViewDetail detailOf(const AssetPart& part) {
    return {part.detail.emission, part.detail.normalMap ? part.detail.normalScale : 0, part.tintedByColors};
}

// Returns the cheapest of the shader's variants that handles these layers and the detail.
uint32_t lookOf(const std::vector<shared::ViewLayer>& layers, bool isDetailed) {
    if (isDetailed) return shared::kSurfaceLook;
    for (const shared::ViewLayer& layer : layers)
        if (layer.channel >= 0 || layer.isTextured) return shared::kSurfaceLook;
    return layers.size() == 1 ? shared::kSingleLook : shared::kLayersLook;
}

// Returns what lookOf() yields for bindings of the set that show something.
std::vector<uint32_t> looksOf(const AssetPart& part, const MaterialSet& set) {
    if (part.detail.isAny()) return {shared::kSurfaceLook};
    const auto bases = size_t(std::ranges::count(set.materials, true, &AssetMaterial::hasBase));
    const size_t plain = set.materials.size() - bases;
    std::vector<uint32_t> looks;
    if (plain > 0) looks.push_back(shared::kSingleLook);
    if (plain > 1) looks.push_back(shared::kLayersLook);
    if (bases > 0 || part.isPainted()) looks.push_back(shared::kSurfaceLook);
    return looks;
}

} // namespace

ViewPass::ViewPass(const vk::Device& device, const Asset& asset, const ViewOptions& options)
    : mDevice(device), mAsset(asset), mBounds(boundsOf(asset)), mDepthFormat(viewDepthFormat(device)),
      mIsUnshadowed(options.isUnshadowed) {
    constexpr VkSamplerAddressMode kClamp = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    mPixelSampler = {device, kClamp, kClamp, "triangle ids", VK_FILTER_NEAREST};
    mDiskSampler = {device, kClamp, kClamp, "view maps"};
    mPolarSampler = {device, VK_SAMPLER_ADDRESS_MODE_REPEAT, kClamp, "polar view maps"};
    mSurfaceSampler = {device, VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_REPEAT,
                       "surface textures"};
    uint32_t firstTriangleId = 1;
    for (const AssetPart& part : asset.parts) {
        mParts.push_back(makePart(part, firstTriangleId));
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
    std::vector<std::pair<vk::Constants, Pixels>> missing;
    for (size_t p = 0; p < mParts.size(); p++)
        for (size_t s = 0; s < mParts[p].sets.size(); s++) {
            const ResidualSet* residual = residualOf(p, s, relighter);
            const bool isShadow = mGroundFade && mGroundFade->part == p && mGroundFade->isShadow;
            const uint32_t estimate = estimateOf(residual, isShadow);
            const MaterialSet& source = mAsset.parts[p].sets[s];
            for (const uint32_t look : looksOf(mAsset.parts[p], source)) {
                // An unshadowed asset is soon replaced, and its first image must not wait for programs that
                // may not be needed.
                if (mIsUnshadowed && (s != mParts[p].bound.set || look != mParts[p].look)) continue;
                std::set<uint32_t> harmonics{mostHarmonics(residual)};
                if (look == shared::kSingleLook && residual) {
                    harmonics.clear();
                    for (const AssetMaterial& material : source.materials)
                        if (!material.hasBase)
                            harmonics.insert(uint32_t(residual->layers[size_t(material.layer)]->harmonics));
                }
                for (const Pixels pixels : {Pixels::All, Pixels::Inner, Pixels::Edges})
                    for (const uint32_t count : harmonics)
                        if ((pixels == Pixels::All) == (mSamples == 1)) {
                            const vk::Constants constants =
                                constantsOf(mParts[p].sets[s], {look, true, estimate, count, pixels});
                            if (mShadePrograms.try_emplace(constants).second)
                                missing.emplace_back(constants, pixels);
                        }
            }
        }
    // A driver takes about a tenth of a second for each.
    parallelFor(missing.size(), [&](size_t i) {
        const auto& [constants, pixels] = missing[i];
        mShadePrograms.at(constants) = makeShadeProgram(constants, pixels);
    });
}

ViewPass::Part ViewPass::makePart(const AssetPart& source, uint32_t firstTriangleId) {
    Part part;
    part.bounds = boundsOf(source.mesh);
    part.isClosed = isClosed(source.mesh);
    const NumberedTriangles numbered = numberTriangles(source.mesh);
    const uint64_t mostVertices = uint64_t(mDevice.limits().maxDrawIndexedIndexValue) + 1;
    if (numbered.positions.size() > mostVertices)
        throw Error(
            fmt::format("{}: {} vertices are drawn, {} counts at most {}; split the mesh into several parts",
                        source.name, numbered.positions.size(), mDevice.name(), mostVertices));
    part.drawnPositions = vk::upload<vec3>(mDevice, numbered.positions, source.name + " drawn positions");
    part.drawnTriangles = vk::upload<uvec3>(mDevice, numbered.triangles, source.name + " drawn triangles");
    expectTexels(mDevice, shared::kVertexTexels * source.mesh.vertexCount(), source.name + " vertices");
    expectTexels(mDevice, source.mesh.triangleCount(), source.name + " triangles");
    part.vertices = uploadBindable(mDevice, verticesOf(source.mesh), source.name + " vertices");
    part.triangles = vk::upload<glm::u32vec4>(mDevice, cornersOf(source.mesh), source.name + " triangles");
    part.clusters = TriangleClusters(source.mesh);
    part.firstTriangleId = firstTriangleId;
    part.triangleCount = uint32_t(source.mesh.triangleCount());
    part.paint = source.paintedByColors ? shared::kPaintedByColors
                 : source.materialMap   ? shared::kPaintedByMap
                                        : shared::kUnpainted;
    const Texture white{1, 1, {0xffffffff}};
    part.baseColor =
        makeSurfaceTexture(mDevice, source.baseColor.value_or(white), source.name + " base color");
    part.materialMap =
        makeSurfaceTexture(mDevice, source.materialMap.value_or(white), source.name + " material map");
    part.normalMap =
        makeSurfaceTexture(mDevice, source.detail.normalMap.value_or(white), source.name + " normal map");
    part.emissionMap =
        makeSurfaceTexture(mDevice, source.detail.emissionMap.value_or(white), source.name + " emission map");
    part.detail = detailOf(source);
    part.isDetailed = source.detail.isAny();
    size_t mostLayers = 1;
    for (const MaterialSet& set : source.sets) {
        RELUME_CHECK_EQ(size_t(verticesOf(set.transport)), source.mesh.vertexCount());
        part.sets.push_back(makeSet(set, source.name));
        part.sets.back().hasTangents = !source.mesh.tangents.empty();
        mostLayers = std::max(mostLayers, 2 * set.materials.size());
    }
    part.layers = vk::Buffer(mDevice, sizeof(shared::ViewDetail) + mostLayers * sizeof(shared::ViewLayer),
                             vk::BufferUse::Device, source.name + " bound layers");
    return part;
}

ViewPass::Set ViewPass::makeSet(const MaterialSet& source, const std::string& name) {
    Set set;
    set.terms = uint32_t(source.brdf.terms);
    RELUME_CHECK_EQ(set.terms, termsOf(source.transport));
    expectTexels(mDevice, (3 * uint64_t(verticesOf(source.transport)) * set.terms + 3) / 4, name + " tuples");
    set.materials = uint32_t(source.materials.size());
    set.mapping = source.brdf.mapping;
    set.viewMaps = makeViewMapTexture(mDevice, source.brdf, name + " view maps");
    return set;
}

void ViewPass::setAppearance(const Appearance& appearance) {
    RELUME_CHECK_EQ(appearance.size(), mParts.size());
    for (size_t i = 0; i < mParts.size(); i++) {
        Part& part = mParts[i];
        part.bound = appearance[i];
        part.boundLayers.clear();
        for (const BoundLayer& layer : boundLayers(mAsset.parts[i], part.bound))
            part.boundLayers.push_back({uint32_t(layer.layer) * boundSet(part).viewMaps.imagesPerLayer,
                                        layer.channel, layer.textured, layer.weight, 0, 0});
        part.look = lookOf(part.boundLayers, part.isDetailed);
    }
}

vk::Constants ViewPass::constantsOf(const Set& set, const Shading& shading) const {
    return {set.terms,
            uint32_t(set.viewMaps.isGray),
            shading.look,
            uint32_t(shading.allTerms),
            shading.estimate,
            uint32_t(mSamples),
            uint32_t(shading.pixels == Pixels::Edges),
            shading.harmonics,
            uint32_t(set.hasTangents)};
}

vk::GraphicsProgram ViewPass::makeShadeProgram(const vk::Constants& constants, Pixels pixels) const {
    const std::string name = fmt::format("view of {} terms", constants[0]);
    if (pixels == Pixels::All)
        return {mDevice,   view_shade_vert_spirv,      view_shade_frag_spirv,
                constants, shadeOptions(mDepthFormat), name};
    const bool isOfEdges = pixels == Pixels::Edges;
    vk::GraphicsOptions options = shadeOptions(mDepthFormat, isOfEdges ? kEdgeBit : 0xff);
    options.addsColor = isOfEdges;
    return {mDevice,
            view_shade_vert_spirv,
            view_shade_samples_frag_spirv,
            constants,
            options,
            name + (isOfEdges ? ", edges" : "")};
}

const vk::GraphicsProgram& ViewPass::shadeProgram(const Set& set, const Shading& shading) {
    const vk::Constants constants = constantsOf(set, shading);
    vk::GraphicsProgram& program = mShadePrograms[constants];
    if (!program.pipeline()) program = makeShadeProgram(constants, shading.pixels);
    return program;
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

void ViewPass::drawTriangleIds(vk::Commands& commands, const Frame& frame, const Part& part) const {
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

void ViewPass::inspect(vk::Commands& commands, const Frame& frame, const Part& part) {
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
    const auto mark = [&](const Part& part, const Bounds& bounds, uint32_t stencil) {
        const std::optional<shared::ViewRays> rays = raysOf(frame, bounds);
        if (!rays || part.triangleCount == 0) return;
        commands.bind(program,
                      {{mTriangleIds, mPixelSampler},
                       vk::Binding::texelsOf(part.triangles, VK_FORMAT_R32G32B32A32_UINT)},
                      shared::ViewEdgesPush{*rays, part.firstTriangleId, part.triangleCount});
        commands.setStencil(stencil | kEdgeBit);
        commands.draw(6);
    };
    for (const Part& part : mParts) mark(part, part.bounds, stencilOf(part));
    // Test pixels whose first sample is empty once, with the data of any part.
    const auto any = std::ranges::find_if(mParts, [](const Part& part) { return part.triangleCount > 0; });
    if (any != mParts.end()) mark(*any, mBounds, 0);
}

uint32_t ViewPass::estimateOf(const ResidualSet* residual, bool isShadow) const {
    const uint32_t shadow = isShadow ? shared::kShadow : 0;
    if (!residual) return shared::kTermsAlone + shadow;
    if (mIsUnshadowed) return shared::kUnshadowed + shadow;
    return (residual->hasNonnegativeTerms ? shared::kResidualRatio : shared::kResidualDifference) +
           (residual->isBounced ? shared::kBounced : 0) + shadow;
}

const ResidualSet* ViewPass::residualOf(size_t part, size_t set, const Relighter& relighter) const {
    return mAddsResidual ? relighter.spheres().set(part, set) : nullptr;
}

void ViewPass::recordSpheres(vk::Commands& commands, const Frame& frame, const Relighter& relighter) {
    std::set<uint32_t> kernels, nodes;
    for (size_t i = 0; i < mParts.size(); i++) {
        Part& part = mParts[i];
        const ResidualSet* residual = residualOf(i, part.bound.set, relighter);
        const std::optional<shared::ViewRays> rays = raysOf(frame, part.bounds);
        if (!residual || !rays || part.triangleCount == 0 || part.boundLayers.empty()) continue;
        const vec2 size(float(mColor.options().width), float(mColor.options().height));
        const vec4 rectangle = 0.5f * (rays->rectangle + 1.0f) * vec4(size, size);
        addGridNodes(nodes, rays->corner, rays->right, rays->down, vec2(rectangle),
                     {rectangle.z, rectangle.w});
        for (shared::ViewLayer& layer : part.boundLayers) {
            const size_t number = layer.firstMap / boundSet(part).viewMaps.imagesPerLayer;
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
                     Pixels pixels) {
    const Part& part = mParts[number];
    const Set& set = boundSet(part);
    const LitSpheres& spheres = relighter.spheres();
    const ResidualSet* residual = residualOf(number, part.bound.set, relighter);
    const auto tuplesOf = [](const vk::Buffer& tuples) {
        return vk::Binding::texelsOf(tuples, VK_FORMAT_R32G32B32A32_SFLOAT);
    };
    const std::optional<shared::ViewRays> rays = raysOf(frame, part.bounds);
    if (!rays || part.triangleCount == 0) return;
    const bool usesAll = mTerms <= 0 || uint32_t(mTerms) >= set.terms;
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
    const uint32_t harmonics = isSingle && residual ? part.boundLayers[0].harmonics : mostHarmonics(residual);
    const uint32_t estimate = estimateOf(residual, fades && mGroundFade->isShadow);
    commands.bind(shadeProgram(set, {part.look, usesAll, estimate, harmonics, pixels}),
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
                   tuplesOf(relighter.fillTuples(number, part.bound.set))},
                  push);
    commands.setStencil(pixels == Pixels::Edges ? kEdgeBit : stencilOf(part));
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
    commands.render({.color = &mTriangleIds, .depth = &mDepth, .firstSamples = firstSamples}, [&] {
        for (const Part& part : mParts) drawTriangleIds(commands, frame, part);
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
    for (const Part& part : mParts)
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
        const auto shadeAll = [&](Pixels pixels) {
            for (size_t i = 0; i < mParts.size(); i++) shade(commands, frame, i, relighter, pixels);
        };
        commands.render({.color = &mColor, .depth = &depth(), .keepsDepth = true}, [&] {
            if (mInspect != Inspect::Off) {
                for (const Part& part : mParts) inspect(commands, frame, part);
            } else if (mSamples == 1) {
                shadeAll(Pixels::All);
            } else {
                if (!std::exchange(mHasMarkedEdges, true)) markEdges(commands, frame);
                shadeAll(Pixels::Inner);
                shadeAll(Pixels::Edges);
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
