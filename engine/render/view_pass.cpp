#include "engine/render/view_pass.h"

#include "engine/base/error.h"
#include "engine/render/map_texture.h"
#include "engine/vk/upload.h"
#include "shaders/view_clamp_frag.h"
#include "shaders/view_frag.h"
#include "shaders/view_vert.h"

#include <algorithm>
#include <span>

namespace relume {

using vk::Stage;

namespace {

constexpr VkFormat kColorFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

// A varying, whatever its width, takes a location of four components. Five are not for terms: the
// position in clip space and those that view.vert numbers 0 to 3.
uint32_t largestTermsPerDraw(const VkPhysicalDeviceLimits& limits) {
    return std::min(limits.maxVertexOutputComponents, limits.maxFragmentInputComponents) / 4 - 5;
}

bool canBlend(const vk::Device& device) {
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(device.physical(), kColorFormat, &properties);
    return properties.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
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

// The least of the shader's ways that serves these layers.
uint32_t lookOf(const std::vector<shared::ViewLayer>& layers) {
    for (const shared::ViewLayer& layer : layers)
        if (layer.channel >= 0 || layer.isTextured) return shared::kSurfaceLook;
    return layers.size() == 1 ? shared::kSingleLook : shared::kLayersLook;
}

} // namespace

ViewPass::ViewPass(const vk::Device& device, const Asset& asset, const ViewOptions& options)
    : mDevice(device), mAsset(asset), mBounds(boundsOf(asset)),
      mTermsPerDraw(largestTermsPerDraw(device.limits())) {
    if (options.termsPerDraw > 0) mTermsPerDraw = std::min(mTermsPerDraw, options.termsPerDraw);
    const vk::GraphicsOptions clamp{.colorFormat = kColorFormat,
                                    .depthFormat = kDepthFormat,
                                    .depthCompare = VK_COMPARE_OP_EQUAL,
                                    .depthWrite = false,
                                    .blend = vk::Blend::Max};
    mClampProgram =
        vk::GraphicsProgram(device, view_vert_spirv, view_clamp_frag_spirv, {1}, clamp, "view clamp");
    constexpr VkSamplerAddressMode kClamp = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    mDiskSampler = {device, kClamp, kClamp, "view maps"};
    mPolarSampler = {device, VK_SAMPLER_ADDRESS_MODE_REPEAT, kClamp, "polar view maps"};
    mSurfaceSampler = {device, VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_REPEAT,
                       "surface textures"};
    for (const AssetPart& part : asset.parts) mParts.push_back(makePart(part));
    setAppearance(defaultAppearance(asset));
    resize(options.width, options.height);
}

ViewPass::Part ViewPass::makePart(const AssetPart& source) {
    Part part;
    part.vertices = uploadBindable(mDevice, verticesOf(source.mesh), source.name + " vertices");
    part.indices =
        vk::uploadBytes(mDevice, std::as_bytes(std::span(source.mesh.triangles)), source.name + " indices");
    part.indexCount = uint32_t(3 * source.mesh.triangleCount());
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
    const FactoredBrdf& brdf = source.brdf;
    RELUME_CHECK_EQ(uint32_t(brdf.terms), termsOf(source.transport));
    const auto maps = uint32_t(brdf.layers * brdf.terms);
    if (maps > mDevice.limits().maxImageArrayLayers)
        throw Error(
            "{}: a set of {} layers with {} terms needs {} view maps, {} holds at most {}; bake fewer "
            "materials or terms in a set",
            name, brdf.layers, brdf.terms, maps, mDevice.name(), mDevice.limits().maxImageArrayLayers);
    Set set;
    set.terms = uint32_t(brdf.terms);
    set.materials = uint32_t(source.materials.size());
    set.mapping = brdf.mapping;
    set.viewMaps = makeMapTexture(mDevice, brdf.viewMaps, uint32_t(brdf.size), maps, name + " view maps");
    planDraws(set);
    return set;
}

void ViewPass::planDraws(Set& set) {
    set.clamps = set.terms > mTermsPerDraw;
    if (set.clamps && !canBlend(mDevice))
        throw Error("{}: {} terms need several draws, and the device cannot blend float images; bake at most "
                    "{} terms for it",
                    mDevice.name(), set.terms, mTermsPerDraw);
    for (uint32_t term = 0; term < set.terms; term += mTermsPerDraw) {
        Draw& draw = set.draws.emplace_back(Draw{term, {}});
        for (uint32_t look : {shared::kSingleLook, shared::kLayersLook, shared::kSurfaceLook})
            draw.programs[look] =
                &program(std::min(mTermsPerDraw, set.terms - term), term == 0, !set.clamps, look);
    }
}

void ViewPass::setAppearance(const Appearance& appearance) {
    RELUME_CHECK_EQ(appearance.size(), mParts.size());
    for (size_t i = 0; i < mParts.size(); i++) {
        Part& part = mParts[i];
        part.worn = appearance[i];
        part.wornLayers.clear();
        for (const WornLayer& layer : wornLayers(mAsset.parts[i], part.worn))
            part.wornLayers.push_back({uint32_t(layer.layer) * part.sets[part.worn.set].terms, layer.channel,
                                       layer.textured, layer.weight});
        part.look = lookOf(part.wornLayers);
    }
}

const vk::GraphicsProgram& ViewPass::program(uint32_t terms, bool first, bool clamps, uint32_t look) {
    vk::GraphicsProgram& program = mPrograms[{terms, first, clamps, look}];
    if (program.pipeline()) return program;
    const vk::GraphicsOptions options{.colorFormat = kColorFormat,
                                      .depthFormat = kDepthFormat,
                                      .depthCompare = first ? VK_COMPARE_OP_LESS : VK_COMPARE_OP_EQUAL,
                                      .depthWrite = first,
                                      .blend = first ? vk::Blend::None : vk::Blend::Add};
    program = vk::GraphicsProgram(mDevice, view_vert_spirv, view_frag_spirv, {terms, uint32_t(clamps), look},
                                  options, fmt::format("view of {} terms", terms));
    return program;
}

void ViewPass::resize(int width, int height) {
    RELUME_CHECK(width > 0 && height > 0);
    vk::ImageOptions options{.format = kColorFormat, .width = uint32_t(width), .height = uint32_t(height)};
    options.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    mColor = vk::Image(mDevice, options, "view color");
    options.format = kDepthFormat;
    options.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    mDepth = vk::Image(mDevice, options, "view depth");
}

void ViewPass::draw(vk::Commands& commands, const Frame& frame, const Part& part, uint32_t firstTerm,
                    const vk::GraphicsProgram& program, const vk::Buffer& tuples) const {
    const Set& set = wornSet(part);
    const bool isSingle = part.look == shared::kSingleLook;
    const shared::ViewPush push{frame.clipFromWorld,
                                frame.eye,
                                set.terms,
                                firstTerm,
                                uint32_t(set.mapping),
                                isSingle ? part.wornLayers[0].firstMap : 0,
                                isSingle ? part.wornLayers[0].weight : 0,
                                uint32_t(part.wornLayers.size()),
                                part.worn.painted ? part.paint : shared::kUnpainted,
                                set.materials};
    if (&program == &mClampProgram)
        commands.bind(program, {part.vertices, tuples}, push);
    else
        commands.bind(program,
                      {part.vertices,
                       tuples,
                       {set.viewMaps, set.mapping == DiskMapping::Polar ? mPolarSampler : mDiskSampler},
                       part.layers,
                       {part.baseColor, mSurfaceSampler},
                       {part.materialMap, mSurfaceSampler}},
                      push);
    commands.drawIndexed(part.indices, part.indexCount, 1);
}

void ViewPass::record(vk::Commands& commands, const Camera& camera, const Relighter& relighter) const {
    RELUME_CHECK_EQ(relighter.parts(), mParts.size());
    const float aspect = float(mColor.options().width) / float(mColor.options().height);
    const Frame frame{camera.clipFromWorld(aspect, mBounds), camera.eye};
    commands.barrier(Stage::Draw, Stage::Transfer); // an earlier frame may still be reading the layers
    for (const Part& part : mParts)
        if (!part.wornLayers.empty()) commands.update(part.layers, std::as_bytes(std::span(part.wornLayers)));
    commands.barrier(Stage::Transfer, Stage::Draw);
    const auto drawPart = [&](size_t i, uint32_t firstTerm, const vk::GraphicsProgram& program) {
        draw(commands, frame, mParts[i], firstTerm, program, relighter.tuples(i, mParts[i].worn.set));
    };
    const auto drawTerms = [&](size_t i, const Draw& step) {
        drawPart(i, step.firstTerm, *step.programs[mParts[i].look]);
    };
    commands.pass("view", [&] {
        commands.transition(mColor, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                            Stage::Transfer, Stage::Color);
        commands.transition(mDepth, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                            Stage::Color, Stage::Color);
        commands.render({.color = &mColor, .depth = &mDepth}, [&] {
            // Depth is settled over all parts before any adds to what it shows.
            for (size_t i = 0; i < mParts.size(); i++) drawTerms(i, wornSet(mParts[i]).draws[0]);
            for (size_t i = 0; i < mParts.size(); i++) {
                const Set& set = wornSet(mParts[i]);
                for (size_t d = 1; d < set.draws.size(); d++) drawTerms(i, set.draws[d]);
                if (set.clamps) drawPart(i, 0, mClampProgram);
            }
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

Image ViewPass::render(const Camera& camera, const Relighter& relighter) const {
    vk::Commands commands(mDevice, "view");
    commands.begin();
    record(commands, camera, relighter);
    commands.submitAndWait();
    return read();
}

} // namespace relume
