#include "engine/render/view_pass.h"

#include "engine/base/error.h"
#include "engine/render/map_texture.h"
#include "engine/render/numbered_triangles.h"
#include "engine/render/view_grid.h"
#include "engine/scene/closed_mesh.h"
#include "engine/vk/upload.h"
#include "shaders/view_inspect_frag.h"
#include "shaders/view_shade_frag.h"
#include "shaders/view_shade_vert.h"
#include "shaders/view_surface_frag.h"
#include "shaders/view_surface_vert.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace relume {

using vk::Stage;

namespace {

constexpr VkFormat kColorFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkFormat kSurfaceFormat = VK_FORMAT_R32_UINT;

// Where it is offered 24 bits of depth, since they take half the memory of 32 and as precise where most of a
// scene is: beyond twice the near plane's distance. One of the two always is.
VkFormat depthFormatOf(const vk::Device& device) {
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(device.physical(), VK_FORMAT_D24_UNORM_S8_UINT, &properties);
    return properties.optimalTilingFeatures & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT
               ? VK_FORMAT_D24_UNORM_S8_UINT
               : VK_FORMAT_D32_SFLOAT_S8_UINT;
}

float pixelFraction(const vk::Device& device) {
    return std::exp2(-float(device.limits().subPixelPrecisionBits));
}

// `orElse`: what helps besides.
void expectTexels(const vk::Device& device, uint64_t texels, const std::string& name,
                  const std::string& orElse = "") {
    if (texels > device.limits().maxTexelBufferElements)
        throw Error("{}: {} texels are needed, {} reads at most {} of a buffer; split the mesh into several "
                    "parts{}",
                    name, texels, device.name(), device.limits().maxTexelBufferElements, orElse);
}

// Of what pixels show where the stencil says that they may.
vk::GraphicsOptions shadeOptions(VkFormat depthFormat) {
    return {.colorFormat = kColorFormat,
            .depthFormat = depthFormat,
            .depthCompare = VK_COMPARE_OP_ALWAYS,
            .depthWrite = false,
            .stencil = vk::Stencil::Equal};
}

template <typename T>
vk::Buffer uploadBindable(const vk::Device& device, const std::vector<T>& values, const std::string& name) {
    const uint64_t bytes = std::span(values).size_bytes();
    if (bytes > device.largestStorageBuffer())
        throw Error("{}: {} bytes are needed, {} binds at most {}; split the mesh into several parts", name,
                    bytes, device.name(), device.largestStorageBuffer());
    return vk::upload<T>(device, values, name);
}

std::vector<shared::ViewVertex> verticesOf(const Mesh& mesh) {
    RELUME_CHECK_EQ(mesh.normals.size(), mesh.positions.size());
    std::vector<shared::ViewVertex> vertices;
    vertices.reserve(mesh.vertexCount());
    for (size_t v = 0; v < mesh.vertexCount(); v++)
        vertices.push_back({mesh.positions[v], mesh.normals[v], mesh.uvs.empty() ? vec2(0) : mesh.uvs[v],
                            mesh.colors.empty() ? vec4(0) : mesh.colors[v]});
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

// The least of the shader's ways that serves these layers.
uint32_t lookOf(const std::vector<shared::ViewLayer>& layers) {
    for (const shared::ViewLayer& layer : layers)
        if (layer.channel >= 0 || layer.isTextured) return shared::kSurfaceLook;
    return layers.size() == 1 ? shared::kSingleLook : shared::kLayersLook;
}

// Where a box may appear, in clip space after division; everywhere if some of it is nearer than the near
// plane.
struct Footprint {
    bool isWhole = true; // none of it is
    vec2 low = vec2(1), high = vec2(-1);
};

Footprint footprintOf(const Bounds& bounds, const mat4& clipFromWorld) {
    Footprint footprint;
    for (int corner = 0; corner < 8; corner++) {
        const vec3 point(corner & 1 ? bounds.high.x : bounds.low.x, corner & 2 ? bounds.high.y : bounds.low.y,
                         corner & 4 ? bounds.high.z : bounds.low.z);
        const vec4 clip = clipFromWorld * vec4(point, 1);
        if (!(clip.z >= 0 && clip.w > 0)) return {false, vec2(-1), vec2(1)};
        const vec2 place = vec2(clip) / clip.w;
        footprint.low = glm::min(footprint.low, place);
        footprint.high = glm::max(footprint.high, place);
    }
    return footprint;
}

} // namespace

ViewPass::ViewPass(const vk::Device& device, const Asset& asset, const ViewOptions& options)
    : mDevice(device), mAsset(asset), mBounds(boundsOf(asset)), mDepthFormat(depthFormatOf(device)) {
    vk::GraphicsOptions surfaces{.colorFormat = kSurfaceFormat, .depthFormat = mDepthFormat};
    surfaces.stencil = vk::Stencil::Write;
    surfaces.readsPositions = true;
    mSurfaceProgram = {device, view_surface_vert_spirv, view_surface_frag_spirv, {}, surfaces, "surfaces"};
    surfaces.cull = vk::Cull::Clockwise;
    mClosedSurfaceProgram = {device,   view_surface_vert_spirv, view_surface_frag_spirv, {},
                             surfaces, "closed surfaces"};
    constexpr VkSamplerAddressMode kClamp = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    mPixelSampler = {device, kClamp, kClamp, "view surfaces", VK_FILTER_NEAREST};
    mDiskSampler = {device, kClamp, kClamp, "view maps"};
    mPolarSampler = {device, VK_SAMPLER_ADDRESS_MODE_REPEAT, kClamp, "polar view maps"};
    mSurfaceSampler = {device, VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_REPEAT,
                       "surface textures"};
    uint32_t firstSurface = 1;
    for (const AssetPart& part : asset.parts) {
        mParts.push_back(makePart(part, firstSurface));
        firstSurface += mParts.back().surfaces;
    }
    setAppearance(defaultAppearance(asset));
    resize(options.width, options.height);
}

ViewPass::Part ViewPass::makePart(const AssetPart& source, uint32_t firstSurface) {
    Part part;
    part.bounds = boundsOf(source.mesh);
    part.isClosed = isClosed(source.mesh);
    const NumberedTriangles numbered = numberTriangles(source.mesh);
    const uint64_t mostVertices = uint64_t(mDevice.limits().maxDrawIndexedIndexValue) + 1;
    if (numbered.positions.size() > mostVertices)
        throw Error("{}: {} vertices are drawn, {} counts at most {}; split the mesh into several parts",
                    source.name, numbered.positions.size(), mDevice.name(), mostVertices);
    part.drawnPositions = vk::upload<vec3>(mDevice, numbered.positions, source.name + " drawn positions");
    part.drawnTriangles = vk::upload<uvec3>(mDevice, numbered.triangles, source.name + " drawn triangles");
    expectTexels(mDevice, sizeof(shared::ViewVertex) / sizeof(vec4) * source.mesh.vertexCount(),
                 source.name + " vertices");
    expectTexels(mDevice, source.mesh.triangleCount(), source.name + " triangles");
    part.vertices = uploadBindable(mDevice, verticesOf(source.mesh), source.name + " vertices");
    part.triangles = vk::upload<glm::u32vec4>(mDevice, cornersOf(source.mesh), source.name + " triangles");
    part.clusters = TriangleClusters(source.mesh);
    part.firstSurface = firstSurface;
    part.surfaces = uint32_t(source.mesh.triangleCount());
    part.paint = source.paintedByColors ? shared::kPaintedByColors
                 : source.materialMap   ? shared::kPaintedByMap
                                        : shared::kUnpainted;
    const Texture white{1, 1, {0xffffffff}};
    part.baseColor =
        makeSurfaceTexture(mDevice, source.baseColor.value_or(white), source.name + " base colour");
    part.materialMap =
        makeSurfaceTexture(mDevice, source.materialMap.value_or(white), source.name + " material map");
    size_t mostLayers = 1;
    for (const MaterialSet& set : source.sets) {
        RELUME_CHECK_EQ(size_t(verticesOf(set.transport)), source.mesh.vertexCount());
        part.sets.push_back(makeSet(set, source.name));
        mostLayers = std::max(mostLayers, 2 * set.materials.size());
    }
    part.layers = vk::Buffer(mDevice, mostLayers * sizeof(shared::ViewLayer), vk::BufferUse::Device,
                             source.name + " worn layers");
    return part;
}

ViewPass::Set ViewPass::makeSet(const MaterialSet& source, const std::string& name) {
    Set set;
    set.terms = uint32_t(source.brdf.terms);
    RELUME_CHECK_EQ(set.terms, termsOf(source.transport));
    const uint64_t texels = 3 * uint64_t(verticesOf(source.transport)) * set.terms / set.floatsPerTexel();
    expectTexels(
        mDevice, texels, name + " tuples",
        set.floatsPerTexel() == 1
            ? fmt::format(", or bake a K that is a multiple of four (not {}): it takes a quarter", set.terms)
            : "");
    set.materials = uint32_t(source.materials.size());
    set.mapping = source.brdf.mapping;
    set.viewMaps = makeViewMapTexture(mDevice, source.brdf, name + " view maps");
    for (uint32_t look : {shared::kSingleLook, shared::kLayersLook, shared::kSurfaceLook})
        set.programs[look] = &shadeProgram(set.terms, set.viewMaps.isGrey, look);
    return set;
}

void ViewPass::setAppearance(const Appearance& appearance) {
    RELUME_CHECK_EQ(appearance.size(), mParts.size());
    for (size_t i = 0; i < mParts.size(); i++) {
        Part& part = mParts[i];
        part.worn = appearance[i];
        part.wornLayers.clear();
        for (const WornLayer& layer : wornLayers(mAsset.parts[i], part.worn))
            part.wornLayers.push_back({uint32_t(layer.layer) * wornSet(part).viewMaps.imagesPerLayer,
                                       layer.channel, layer.textured, layer.weight, 0});
        part.look = lookOf(part.wornLayers);
    }
}

const vk::GraphicsProgram& ViewPass::shadeProgram(uint32_t terms, bool grey, uint32_t look, bool allTerms,
                                                  uint32_t estimate) {
    vk::GraphicsProgram& program =
        mShadePrograms[{terms, uint32_t(grey), look, uint32_t(allTerms), estimate}];
    if (!program.pipeline())
        program = vk::GraphicsProgram(mDevice, view_shade_vert_spirv, view_shade_frag_spirv,
                                      {terms, uint32_t(grey), look, uint32_t(allTerms), estimate},
                                      shadeOptions(mDepthFormat), fmt::format("view of {} terms", terms));
    return program;
}

void ViewPass::resize(int width, int height) {
    RELUME_CHECK(width > 0 && height > 0);
    vk::ImageOptions options{.format = kColorFormat, .width = uint32_t(width), .height = uint32_t(height)};
    options.usage =
        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    mColor = vk::Image(mDevice, options, "view color");
    options.format = kSurfaceFormat;
    options.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    mSurfaces = vk::Image(mDevice, options, "view surfaces");
    options.format = mDepthFormat;
    options.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    mDepth = vk::Image(mDevice, options, "view depth");
}

ViewPass::Frame ViewPass::frameOf(const Camera& camera) const {
    const auto width = int(mColor.options().width), height = int(mColor.options().height);
    const vec3 forward = glm::normalize(camera.target - camera.eye);
    // At unit depth, where directions are linear in x and y.
    const auto centre = [&](int x, int y) {
        const vec3 direction = camera.pixelDirection(x, y, width, height);
        return direction / glm::dot(direction, forward);
    };
    Frame frame;
    frame.clipFromWorld = camera.clipFromWorld(float(width) / float(height), mBounds);
    frame.eye = camera.eye;
    frame.right = (centre(width, 0) - centre(0, 0)) / float(width);
    frame.down = (centre(0, height) - centre(0, 0)) / float(height);
    frame.corner = centre(0, 0) - 0.5f * (frame.right + frame.down);
    frame.pixel = vec2(2 / float(width), 2 / float(height));
    return frame;
}

void ViewPass::drawSurfaces(vk::Commands& commands, const Frame& frame, const Part& part) const {
    if (part.surfaces == 0) return;
    const bool showsNoBack = part.isClosed && footprintOf(part.bounds, frame.clipFromWorld).isWhole;
    commands.bind(showsNoBack ? mClosedSurfaceProgram : mSurfaceProgram, {},
                  shared::ViewSurfacePush{frame.clipFromWorld, part.firstSurface});
    commands.setPositions(part.drawnPositions);
    commands.setStencil(stencilOf(part));
    const float focalLength = 1 / glm::length(frame.right);
    for (const TriangleRun& run : part.clusters.visible(
             {frame.clipFromWorld, frame.eye, focalLength, pixelFraction(mDevice), showsNoBack}))
        commands.drawIndexed(part.drawnTriangles, 3 * run.count, 1, 3 * run.first);
}

std::optional<shared::ViewRays> ViewPass::raysOf(const Frame& frame, const Part& part) {
    const Footprint footprint = footprintOf(part.bounds, frame.clipFromWorld);
    const vec2 low = glm::max(footprint.low - frame.pixel, vec2(-1)),
               high = glm::min(footprint.high + frame.pixel, vec2(1));
    if (part.surfaces == 0 || low.x >= high.x || low.y >= high.y) return std::nullopt;
    return shared::ViewRays{frame.eye, frame.corner, frame.right, frame.down,
                            vec4(low.x, low.y, high.x, high.y)};
}

void ViewPass::inspect(vk::Commands& commands, const Frame& frame, const Part& part) {
    static_assert(uint32_t(Inspect::Wireframe) == shared::kInspectWireframe &&
                  uint32_t(Inspect::Normals) == shared::kInspectNormals &&
                  uint32_t(Inspect::Density) == shared::kInspectDensity);
    const std::optional<shared::ViewRays> rays = raysOf(frame, part);
    if (!rays) return;
    if (!mInspectProgram.pipeline()) {
        mInspectProgram = {mDevice, view_shade_vert_spirv,      view_inspect_frag_spirv,
                           {},      shadeOptions(mDepthFormat), "inspect"};
        mMedianArea = medianAreaOf(mAsset);
    }
    commands.bind(
        mInspectProgram,
        {{mSurfaces, mPixelSampler},
         vk::Binding::texelsOf(part.triangles, VK_FORMAT_R32G32B32A32_UINT),
         vk::Binding::texelsOf(part.vertices, VK_FORMAT_R32G32B32A32_SFLOAT)},
        shared::ViewInspectPush{*rays, part.firstSurface, part.surfaces, uint32_t(mInspect), mMedianArea});
    commands.setStencil(stencilOf(part));
    commands.draw(6);
}

const ResidualSet* ViewPass::residualOf(const Part& part, const Relighter& relighter) const {
    return mAddsResidual ? relighter.spheres().set(size_t(&part - mParts.data()), part.worn.set) : nullptr;
}

void ViewPass::recordSpheres(vk::Commands& commands, const Frame& frame, const Relighter& relighter) {
    std::set<uint32_t> kernels, nodes;
    for (Part& part : mParts) {
        const ResidualSet* residual = residualOf(part, relighter);
        const std::optional<shared::ViewRays> rays = raysOf(frame, part);
        if (!residual || !rays || part.wornLayers.empty()) continue;
        const vec2 size(float(mColor.options().width), float(mColor.options().height));
        const vec4 rectangle = 0.5f * (rays->rectangle + 1.0f) * vec4(size, size);
        addGridNodes(nodes, rays->corner, rays->right, rays->down, vec2(rectangle),
                     {rectangle.z, rectangle.w});
        for (shared::ViewLayer& layer : part.wornLayers) {
            const size_t number = layer.firstMap / wornSet(part).viewMaps.imagesPerLayer;
            const uint32_t kernel = relighter.spheres().kernel(residual->layers[number].get());
            layer.firstSlot = kernel * shared::kGridNodes;
            kernels.insert(kernel);
        }
    }
    if (!kernels.empty())
        relighter.spheres().record(commands, std::vector(kernels.begin(), kernels.end()), nodes);
}

void ViewPass::shade(vk::Commands& commands, const Frame& frame, const Part& part,
                     const Relighter& relighter) {
    const Set& set = wornSet(part);
    const LitSpheres& spheres = relighter.spheres();
    const ResidualSet* residual = residualOf(part, relighter);
    const uint32_t estimate = !residual              ? shared::kTermsAlone
                              : residual->isPositive ? shared::kResidualRatio
                                                     : shared::kResidualDifference;
    const vk::Buffer& tuples = relighter.tuples(size_t(&part - mParts.data()), part.worn.set);
    const std::optional<shared::ViewRays> rays = raysOf(frame, part);
    if (!rays) return;
    const bool usesAll = mTerms <= 0 || uint32_t(mTerms) >= set.terms;
    const bool isSingle = part.look == shared::kSingleLook;
    const shared::ViewShadePush push{*rays,
                                     part.firstSurface,
                                     part.surfaces,
                                     uint32_t(set.mapping),
                                     isSingle ? part.wornLayers[0].firstMap : 0,
                                     isSingle ? part.wornLayers[0].weight : 0,
                                     uint32_t(part.wornLayers.size()),
                                     part.worn.painted ? part.paint : shared::kUnpainted,
                                     set.materials,
                                     usesAll ? set.terms : uint32_t(mTerms),
                                     isSingle ? part.wornLayers[0].firstSlot : 0,
                                     residual ? spheres.firstTuples(residual) : 0,
                                     residual ? spheres.firstWeight(residual) : 0};
    commands.bind(usesAll && estimate == shared::kTermsAlone
                      ? *set.programs[part.look]
                      : shadeProgram(set.terms, set.viewMaps.isGrey, part.look, usesAll, estimate),
                  {{mSurfaces, mPixelSampler},
                   vk::Binding::texelsOf(part.triangles, VK_FORMAT_R32G32B32A32_UINT),
                   vk::Binding::texelsOf(part.vertices, VK_FORMAT_R32G32B32A32_SFLOAT),
                   vk::Binding::texelsOf(tuples, set.floatsPerTexel() == 4 ? VK_FORMAT_R32G32B32A32_SFLOAT
                                                                           : VK_FORMAT_R32_SFLOAT),
                   {set.viewMaps.image, set.mapping == DiskMapping::Polar ? mPolarSampler : mDiskSampler},
                   part.layers,
                   {part.baseColor, mSurfaceSampler},
                   {part.materialMap, mSurfaceSampler},
                   {spheres.image(), mPolarSampler},
                   vk::Binding::texelsOf(spheres.slots(), VK_FORMAT_R32_UINT),
                   vk::Binding::texelsOf(spheres.grid(), VK_FORMAT_R32G32B32A32_SFLOAT),
                   {spheres.tuples(), mPolarSampler},
                   vk::Binding::texelsOf(spheres.weights(), VK_FORMAT_R32G32B32A32_SFLOAT)},
                  push);
    commands.setStencil(stencilOf(part));
    commands.draw(6);
}

void ViewPass::record(vk::Commands& commands, const Camera& camera, const Relighter& relighter) {
    RELUME_CHECK_EQ(relighter.parts(), mParts.size());
    const Frame frame = frameOf(camera);
    if (mInspect == Inspect::Off) recordSpheres(commands, frame, relighter);
    commands.barrier(Stage::Draw, Stage::Transfer); // an earlier frame may still be reading the layers
    for (const Part& part : mParts)
        if (!part.wornLayers.empty()) commands.update(part.layers, std::as_bytes(std::span(part.wornLayers)));
    commands.barrier(Stage::Transfer, Stage::Draw);
    commands.pass("view", [&] {
        commands.transition(mSurfaces, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                            Stage::Draw, Stage::Color);
        commands.transition(mDepth, VK_IMAGE_LAYOUT_UNDEFINED,
                            VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, Stage::Color, Stage::Color);
        commands.render({.color = &mSurfaces, .depth = &mDepth}, [&] {
            for (const Part& part : mParts) drawSurfaces(commands, frame, part);
        });
        commands.transition(mSurfaces, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                            VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, Stage::Color, Stage::Draw);
        commands.transition(mColor, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                            Stage::Transfer, Stage::Color);
        commands.barrier(Stage::Color, Stage::Color);
        commands.render({.color = &mColor, .depth = &mDepth, .keepsDepth = true}, [&] {
            for (size_t i = 0; i < mParts.size(); i++)
                if (mInspect == Inspect::Off)
                    shade(commands, frame, mParts[i], relighter);
                else
                    inspect(commands, frame, mParts[i]);
        });
        commands.transition(mColor, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                            VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, Stage::Color, Stage::Transfer);
    });
}

Image ViewPass::read() const {
    Image image(int(mColor.options().width), int(mColor.options().height));
    const vk::Buffer readback(mDevice, std::span(image.pixels).size_bytes(), vk::BufferUse::Readback,
                              "view readback");
    vk::Commands commands(mDevice, "view readback");
    commands.begin();
    commands.copy(mColor, readback, 1);
    commands.barrier(Stage::Transfer, Stage::Host);
    commands.submitAndWait();
    const std::span<vec4> pixels = readback.map<vec4>();
    std::copy(pixels.begin(), pixels.end(), image.pixels.begin());
    return image;
}

Image ViewPass::render(const Camera& camera, const Relighter& relighter) {
    vk::Commands commands(mDevice, "view");
    commands.begin();
    record(commands, camera, relighter);
    commands.submitAndWait();
    return read();
}

} // namespace relume
