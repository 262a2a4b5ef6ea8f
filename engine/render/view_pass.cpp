#include "engine/render/view_pass.h"

#include "engine/base/error.h"
#include "engine/render/map_texture.h"
#include "engine/vk/upload.h"
#include "shaders/shared/render.h"
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

// A varying, whatever its width, takes a location of four components. Three are not for terms: the
// position in clip space and those that view.vert numbers 0 and 1.
uint32_t largestTermsPerDraw(const VkPhysicalDeviceLimits& limits) {
    return std::min(limits.maxVertexOutputComponents, limits.maxFragmentInputComponents) / 4 - 3;
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
    for (size_t v = 0; v < mesh.vertexCount(); v++) vertices.push_back({mesh.positions[v], mesh.normals[v]});
    return vertices;
}

} // namespace

ViewPass::ViewPass(const vk::Device& device, const Asset& asset, const ViewOptions& options)
    : mDevice(device), mBounds(boundsOf(asset)), mTermsPerDraw(largestTermsPerDraw(device.limits())) {
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
    for (const AssetPart& part : asset.parts) mParts.push_back(makePart(part));
    resize(options.width, options.height);
}

ViewPass::Part ViewPass::makePart(const AssetPart& source) {
    const FactoredBrdf& brdf = source.brdf;
    RELUME_CHECK_EQ(uint32_t(brdf.terms), source.transport.terms);
    RELUME_CHECK_EQ(size_t(source.transport.vertices), source.mesh.vertexCount());
    Part part;
    part.vertices = uploadBindable(mDevice, verticesOf(source.mesh), source.name + " vertices");
    part.rowScales = uploadBindable(mDevice, source.transport.scales, source.name + " row scales");
    part.indices =
        vk::uploadBytes(mDevice, std::as_bytes(std::span(source.mesh.triangles)), source.name + " indices");
    part.indexCount = uint32_t(3 * source.mesh.triangleCount());
    part.terms = uint32_t(brdf.terms);
    part.mapping = brdf.mapping;
    part.viewMaps =
        makeMapTexture(mDevice, brdf.viewMaps, uint32_t(brdf.size), part.terms, source.name + " view maps");
    planDraws(part);
    return part;
}

void ViewPass::planDraws(Part& part) {
    part.clamps = part.terms > mTermsPerDraw;
    if (part.clamps && !canBlend(mDevice))
        throw Error("{}: {} terms need several draws, and the device cannot blend float images; bake at most "
                    "{} terms for it",
                    mDevice.name(), part.terms, mTermsPerDraw);
    for (uint32_t term = 0; term < part.terms; term += mTermsPerDraw)
        part.draws.push_back(
            {term, &program(std::min(mTermsPerDraw, part.terms - term), term == 0, !part.clamps)});
}

const vk::GraphicsProgram& ViewPass::program(uint32_t terms, bool first, bool clamps) {
    vk::GraphicsProgram& program = mPrograms[{terms, first, clamps}];
    if (program.pipeline()) return program;
    const vk::GraphicsOptions options{.colorFormat = kColorFormat,
                                      .depthFormat = kDepthFormat,
                                      .depthCompare = first ? VK_COMPARE_OP_LESS : VK_COMPARE_OP_EQUAL,
                                      .depthWrite = first,
                                      .blend = first ? vk::Blend::None : vk::Blend::Add};
    program = vk::GraphicsProgram(mDevice, view_vert_spirv, view_frag_spirv, {terms, uint32_t(clamps)},
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

void ViewPass::record(vk::Commands& commands, const Camera& camera, const Relighter& relighter,
                      const LightPass& light) const {
    RELUME_CHECK_EQ(relighter.parts(), mParts.size());
    const float aspect = float(mColor.options().width) / float(mColor.options().height);
    const mat4 clipFromWorld = camera.clipFromWorld(aspect, mBounds);
    const auto draw = [&](size_t i, const Draw& step, bool sampled) {
        const Part& part = mParts[i];
        const shared::ViewPush push{clipFromWorld, camera.eye, part.terms, step.firstTerm,
                                    uint32_t(part.mapping)};
        if (sampled)
            commands.bind(
                *step.program,
                {part.vertices,
                 relighter.sums(i),
                 part.rowScales,
                 light.scale(),
                 {part.viewMaps, part.mapping == DiskMapping::Polar ? mPolarSampler : mDiskSampler}},
                push);
        else
            commands.bind(*step.program, {part.vertices, relighter.sums(i), part.rowScales, light.scale()},
                          push);
        commands.drawIndexed(part.indices, part.indexCount, 1);
    };
    commands.pass("view", [&] {
        commands.transition(mColor, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                            Stage::Transfer, Stage::Color);
        commands.transition(mDepth, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                            Stage::Color, Stage::Color);
        commands.render({.color = &mColor, .depth = &mDepth}, [&] {
            // Depth is settled over all parts before any adds to what it shows.
            for (size_t i = 0; i < mParts.size(); i++) draw(i, mParts[i].draws[0], true);
            for (size_t i = 0; i < mParts.size(); i++) {
                for (size_t d = 1; d < mParts[i].draws.size(); d++) draw(i, mParts[i].draws[d], true);
                if (mParts[i].clamps) draw(i, {0, &mClampProgram}, false);
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

Image ViewPass::render(const Camera& camera, const Relighter& relighter, const LightPass& light) const {
    vk::Commands commands(mDevice, "view");
    commands.begin();
    record(commands, camera, relighter, light);
    commands.submitAndWait();
    return read();
}

} // namespace relume
