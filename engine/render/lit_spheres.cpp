#include "engine/render/lit_spheres.h"

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/math/divide_up.h"
#include "engine/math/tangent_frame.h"
#include "engine/render/ground_fade.h"
#include "engine/render/view_grid.h"
#include "engine/vk/upload.h"
#include "shaders/sphere_cube_comp.h"
#include "shaders/sphere_light_comp.h"
#include "shaders/sphere_reflect_comp.h"
#include "shaders/sphere_spectrum_comp.h"
#include "shaders/sphere_synthesize_comp.h"
#include "shaders/unshadowed_tuples_comp.h"

#include <algorithm>
#include <fmt/core.h>

namespace relume {

using namespace shared;
using vk::BufferUse;
using vk::Stage;

namespace {

constexpr uint32_t kNoSlot = 0xffffffff;
constexpr uint32_t kBatch = 32; // nodes made together, for which the buffers between passes have room
constexpr VkFormat kTexelFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr uint32_t kSphereTexels = kSphereRings * kSphereAzimuths;

// Returns the kernel as the device reads it: [component][four rings of the mirror direction][ring of the
// light][channel].
std::vector<vec4> packed(const SphereKernel& kernel) {
    std::vector<vec4> texels(size_t(kernel.components()) * (kSphereRings / 4) * kSphereRings * 3);
    RELUME_CHECK_EQ(kernel.values.size() * 3, texels.size() * 4);
    for (size_t component = 0; component < size_t(kernel.components()); component++)
        for (size_t row = 0; row < kSphereRings; row++)
            for (size_t ring = 0; ring < kSphereRings; ring++)
                for (size_t channel = 0; channel < 3; channel++)
                    texels[((component * (kSphereRings / 4) + row / 4) * kSphereRings + ring) * 3 +
                           channel][int(row % 4)] =
                        kernel.values[(component * kSphereRings + row) * kSphereRings + ring][int(channel)];
    return texels;
}

// Returns two vec4 per node: its direction, and the direction of azimuth 0.
template <typename Nodes>
std::vector<vec4> gridFrames(const Nodes& nodes) {
    std::vector<vec4> frames;
    for (const uint32_t node : nodes) {
        const TangentFrame frame = tangentFrame(gridDirection(node));
        frames.emplace_back(frame.n, 0);
        frames.emplace_back(frame.s, 0);
    }
    return frames;
}

std::vector<uint32_t> allNodes() {
    std::vector<uint32_t> nodes;
    for (uint32_t node = 0; node < kGridNodes; node++) nodes.push_back(node);
    return nodes;
}

vk::ImageOptions imageOptions(uint32_t width, uint32_t height, uint32_t layers) {
    return {.format = kTexelFormat,
            .width = width,
            .height = height,
            .layers = layers,
            .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                     VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
}

// Makes a black image, ready to be read by shaders.
vk::Image emptyImage(const vk::Device& device, uint32_t width, uint32_t height, uint32_t layers,
                     const char* name) {
    return vk::uploadImage(device, imageOptions(width, height, layers),
                           std::vector<std::byte>(size_t(width) * height * layers * sizeof(vec4)), name);
}

vk::Buffer makeTexels(const vk::Device& device, uint64_t count, const char* name) {
    return {device, std::max<uint64_t>(count, 1) * sizeof(vec4), BufferUse::Device, name};
}

vk::Binding texels(const vk::Buffer& buffer) { return vk::Binding::texelsOf(buffer, kTexelFormat); }

// Reads all layers of an image that shaders can read, and leaves it in that state.
std::vector<vec4> readImage(const vk::Device& device, const vk::Image& image) {
    const vk::ImageOptions& options = image.options();
    const uint64_t count = uint64_t(options.width) * options.height * options.layers;
    const vk::Buffer readback(device, count * sizeof(vec4), BufferUse::Readback, "sphere readback");
    vk::Commands commands(device, "sphere readback");
    commands.begin();
    commands.transition(image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                        Stage::Transfer, Stage::Transfer);
    commands.copy(image, readback, options.layers);
    commands.transition(image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                        Stage::Transfer, Stage::Draw);
    commands.barrier(Stage::Transfer, Stage::Host);
    commands.submitAndWait();
    const auto values = readback.map<vec4>();
    return {values.begin(), values.end()};
}

} // namespace

LitSpheres::LitSpheres(const vk::Device& device, const Asset& asset, bool takesResiduals)
    : mDevice(device), mSampler(device, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, "sphere cube"),
      mPolarSampler(device, VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                    "polar light maps") {
    std::vector<float> weights;
    std::map<const ResidualSet*, Set*> known;
    const std::optional<size_t> ground = groundOf(asset);
    for (size_t part = 0; part < asset.parts.size(); part++) {
        auto& residuals = mResiduals.emplace_back();
        auto& sets = mSetOf.emplace_back();
        for (const MaterialSet& set : asset.parts[part].sets) {
            const auto& residual = residuals.emplace_back(takesResiduals ? set.residual : nullptr);
            sets.push_back(nullptr);
            if (!residual && part != ground) continue;
            Set* const same = residual ? known[residual.get()] : nullptr;
            Set& own = same ? *same : addSet(set.brdf, residual.get(), weights);
            if (residual) known[residual.get()] = &own;
            if (!asset.parts[part].mesh.tangents.empty()) own.isTurned = 1, mTupleRows = kTurnedRows;
            sets.back() = &own;
        }
    }
    if (!mSets.empty()) makePrograms();
    uint32_t components = 1, frequencies = 0;
    for (const Kernel& kernel : mKernels) {
        components = std::max(components, kernel.components);
        mMostParts = std::max(mMostParts, kernel.parts());
        frequencies = std::max(frequencies, kernel.push.frequencies);
    }
    const uint32_t batch = mKernels.empty() ? 0 : kBatch;
    mTupleImages = uint32_t(std::max<size_t>(weights.size() / 4, 1));
    weights.resize(std::max<size_t>(weights.size(), 4), 0);
    mWeights = vk::upload<float>(device, weights, "irradiance weights");
    mGrid = vk::upload<vec4>(device, gridFrames(allNodes()), "view grid");
    for (size_t light = 0; light < kLightParts; light++)
        mReduced.push_back(
            {makeTexels(device, 6 * kSphereCubeBordered * kSphereCubeBordered, "sphere cube"),
             vk::Image(device, imageOptions(kSphereCubeBordered, kSphereCubeBordered, 6), "sphere cube")});
    mCells = makeTexels(device, kCellTexels * kTupleLights, "lights of cells");
    const uint32_t tupleImages = kLightParts * mTupleImages;
    mTupleTexels =
        makeTexels(device, uint64_t(tupleImages) * mTupleRows * kTupleAzimuths, "unshadowed tuples");
    mTuples = emptyImage(device, kTupleAzimuths, mTupleRows, tupleImages, "unshadowed tuples");
    mBatchNodes = makeTexels(device, 2 * batch, "sphere nodes");
    mPolar = makeTexels(device, uint64_t(batch) * kSphereTexels, "polar light");
    mSpectrum = makeTexels(device, 2 * uint64_t(batch) * (frequencies + 1) * kSphereRings, "light spectrum");
    mReflected =
        makeTexels(device, uint64_t(batch) * components * (kSphereRings / 4) * 6, "reflected spectrum");
    mParts = makeTexels(device, uint64_t(batch) * mMostParts * kSphereTexels, "sphere parts");
    mImage = emptyImage(device, kSphereAzimuths, mMostParts * kSphereRings, 1, "lit spheres");
    mSlotTable.assign(kLightParts * std::max<size_t>(mKernels.size(), 1) * kGridNodes, kNoSlot);
    mSlots = vk::upload<uint32_t>(device, mSlotTable, "sphere slots");
}

void LitSpheres::makePrograms() {
    mCube = {mDevice, sphere_cube_comp_spirv, {}, "sphere cube"};
    mUnshadowed = {mDevice, unshadowed_tuples_comp_spirv, {}, "unshadowed tuples"};
    mLight = {mDevice, sphere_light_comp_spirv, {}, "sphere light"};
    mSpectrumProgram = {mDevice, sphere_spectrum_comp_spirv, {}, "sphere spectrum"};
    mReflect = {mDevice, sphere_reflect_comp_spirv, {}, "sphere reflect"};
    mSynthesize = {mDevice, sphere_synthesize_comp_spirv, {}, "sphere synthesize"};
}

LitSpheres::Set& LitSpheres::addSet(const FactoredBrdf& factors, const ResidualSet* residual,
                                    std::vector<float>& weights) {
    FactoredBrdf lights = factors;
    lights.layers = 1;
    lights.viewMaps = factors.lightMaps;
    Set& set = mSets.emplace_back(Set{uint32_t(weights.size() / 4), uint32_t(factors.terms),
                                      uint32_t(factors.mapping),
                                      makeViewMapTexture(mDevice, lights, "light maps"), 0});
    weights.resize(weights.size() + divideUp(uint32_t(factors.terms), 4) * 12,
                   0); // whole groups of four terms
    if (!residual) return set;
    float* weight = &weights[4 * size_t(set.firstImage)];
    for (const vec3& each : residual->irradianceWeights)
        for (int channel = 0; channel < 3; channel++) *weight++ = each[channel];
    for (const auto& layer : residual->layers) {
        if (!mKernelNumbers.emplace(layer.get(), uint32_t(mKernels.size())).second) continue;
        mKernels.push_back({{0, uint32_t(layer->frequencies), uint32_t(layer->harmonics)},
                            uint32_t(layer->components()),
                            vk::upload<vec4>(mDevice, packed(*layer), "sphere kernel")});
    }
    return set;
}

void LitSpheres::freeSlots() {
    std::ranges::fill(mSlotTable, kNoSlot);
    mFreeSlots.clear();
    for (uint32_t slot = mSlotCount; slot > 0; slot--) mFreeSlots.push_back(slot - 1);
}

void LitSpheres::recordLight(vk::Commands& commands, const LightPass& light, const FillLight* fill) {
    if (mSets.empty()) return;
    RELUME_CHECK(fill || mKernels.empty());
    freeSlots();
    // Draws and passes of an earlier frame may still be reading.
    commands.barrier(Stage::Compute, Stage::Compute);
    commands.barrier(Stage::Draw, Stage::Compute);
    commands.barrier(Stage::Draw, Stage::Transfer);
    commands.barrier(Stage::Transfer, Stage::Compute);
    commands.pass("unshadowed", [&] {
        for (const LightPart lit : {LightPart::Whole, LightPart::Fill}) {
            const bool isFill = lit == LightPart::Fill;
            commands.dispatch(
                mCube,
                {isFill && fill ? fill->radiance() : light.radiance(), mReduced[size_t(lit)].texels, mCells},
                SphereCubePush{uint32_t(light.faceSize()), isFill},
                {6 * kSphereCubeBordered * kSphereCubeBordered, 1, 1});
        }
        commands.barrier(Stage::Compute, Stage::Compute);
        for (const Set& set : mSets)
            commands.dispatch(
                mUnshadowed,
                {texels(mCells),
                 {set.lightMaps.image, isPolar(DiskMapping(set.mapping)) ? mPolarSampler : mSampler},
                 mTupleTexels},
                UnshadowedTuplesPush{set.mapping, set.terms, set.lightMaps.isGray, set.firstImage, mTupleRows,
                                     set.isTurned, mTupleImages},
                {kTupleAzimuths, set.rows(), divideUp(set.terms, 4)});
        commands.barrier(Stage::Compute, Stage::Transfer);
        const auto copyTo = [&](const vk::Buffer& from, const vk::Image& to, Stage readBy) {
            commands.transition(to, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                Stage::Draw, Stage::Transfer);
            commands.copy(from, to);
            commands.transition(to, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, Stage::Transfer, readBy);
        };
        for (const ReducedLight& reduced : mReduced) copyTo(reduced.texels, reduced.cube, Stage::Compute);
        copyTo(mTupleTexels, mTuples, Stage::Draw);
    });
}

// Makes room for as many spheres as a view needs, and some to spare.
void LitSpheres::makeRoom(size_t spheres) {
    if (spheres <= mSlotCount) return;
    const uint32_t most = mDevice.limits().maxImageArrayLayers;
    if (spheres > most)
        throw Error(fmt::format(
            "{} lit spheres are needed, {} holds at most {} layers in an image; draw fewer materials at "
            "once, or without the residual",
            spheres, mDevice.name(), most));
    mSlotCount = std::min(most, divideUp(uint32_t(spheres + spheres / 4), 16) * 16);
    mRetired.push_back(std::move(mImage));
    mImage = vk::Image(mDevice, imageOptions(kSphereAzimuths, mMostParts * kSphereRings, mSlotCount),
                       "lit spheres");
    freeSlots();
}

void LitSpheres::record(vk::Commands& commands, std::span<const uint32_t> kernels,
                        const std::set<uint32_t>& nodes, bool makesFill) {
    const size_t spheres = (makesFill ? kLightParts : 1) * kernels.size() * nodes.size();
    const bool isNew = spheres > mSlotCount;
    makeRoom(spheres);
    struct Missing {
        uint32_t kernel;
        LightPart lit;
        std::vector<uint32_t> nodes;
    };
    std::vector<Missing> missing;
    std::set<uint32_t> used;
    size_t wanted = 0;
    for (const uint32_t kernel : kernels)
        for (const LightPart lit : {LightPart::Whole, LightPart::Fill}) {
            if (lit == LightPart::Fill && !makesFill) continue;
            missing.push_back({kernel, lit, {}});
            for (const uint32_t node : nodes) {
                const uint32_t slot = mSlotTable[slotOf(kernel, lit, node)];
                if (slot == kNoSlot)
                    missing.back().nodes.push_back(node);
                else
                    used.insert(slot);
            }
            wanted += missing.back().nodes.size();
        }
    if (wanted == 0) return;
    // Evict spheres of other views if there is no room.
    if (mFreeSlots.size() < wanted)
        for (uint32_t& slot : mSlotTable)
            if (slot != kNoSlot && !used.contains(slot)) {
                mFreeSlots.push_back(slot);
                slot = kNoSlot;
            }
    commands.barrier(Stage::Draw, Stage::Transfer);
    commands.barrier(Stage::Compute, Stage::Compute);
    commands.pass("spheres", [&] {
        commands.transition(mImage,
                            isNew ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, Stage::Draw, Stage::Transfer);
        for (const Missing& some : missing)
            for (size_t first = 0; first < some.nodes.size(); first += kBatch)
                makeSpheres(commands, some.kernel, some.lit,
                            std::span(some.nodes)
                                .subspan(first, std::min<size_t>(kBatch, some.nodes.size() - first)));
        commands.transition(mImage, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                            VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, Stage::Transfer, Stage::Draw);
        commands.update(mSlots, std::as_bytes(std::span(mSlotTable)));
        commands.barrier(Stage::Transfer, Stage::Draw);
    });
}

void LitSpheres::makeSpheres(vk::Commands& commands, uint32_t number, LightPart lit,
                             std::span<const uint32_t> nodes) {
    const Kernel& kernel = mKernels[number];
    SpherePush push = kernel.push;
    push.nodes = uint32_t(nodes.size());
    const std::vector<vec4> frames = gridFrames(nodes);
    // The previous batch may still be reading its nodes and copying its spheres.
    commands.barrier(Stage::Compute, Stage::Transfer);
    commands.barrier(Stage::Transfer, Stage::Compute);
    commands.update(mBatchNodes, std::as_bytes(std::span(frames)));
    commands.barrier(Stage::Transfer, Stage::Compute);
    commands.dispatch(mLight, {{mReduced[size_t(lit)].cube, mSampler}, texels(mBatchNodes), mPolar}, push,
                      {kSphereAzimuths, kSphereRings, push.nodes});
    commands.barrier(Stage::Compute, Stage::Compute);
    commands.dispatch(mSpectrumProgram, {texels(mPolar), mSpectrum}, push,
                      {kSphereRings, divideUp(push.frequencies + 1, 8), push.nodes});
    commands.barrier(Stage::Compute, Stage::Compute);
    commands.dispatch(mReflect, {texels(kernel.values), texels(mSpectrum), mReflected}, push,
                      {kSphereRings / 4, kernel.components, divideUp(push.nodes, 2)});
    commands.barrier(Stage::Compute, Stage::Compute);
    commands.dispatch(mSynthesize, {texels(mReflected), mParts}, push,
                      {kSphereAzimuths / 4, kSphereRings / 4, push.nodes * (push.harmonics + 1)});
    commands.barrier(Stage::Compute, Stage::Transfer);
    for (size_t i = 0; i < nodes.size(); i++) {
        uint32_t& slot = mSlotTable[slotOf(number, lit, nodes[i])];
        slot = mFreeSlots.back();
        mFreeSlots.pop_back();
        // A kernel with fewer parts than others leaves rows below them that nothing reads.
        commands.copy(mParts, i * kernel.parts() * kSphereTexels * sizeof(vec4), mImage, slot);
    }
}

std::vector<vec3> LitSpheres::readSphere(uint32_t kernel, uint32_t node, LightPart lit) const {
    const uint32_t slot = mSlotTable[slotOf(kernel, lit, node)];
    RELUME_CHECK(slot != kNoSlot);
    const std::vector<vec4> texels = readImage(mDevice, mImage);
    const auto first = texels.begin() + std::ptrdiff_t(size_t(slot) * mMostParts * kSphereTexels);
    return {first, first + std::ptrdiff_t(mKernels[kernel].parts() * kSphereTexels)};
}

std::vector<vec3> LitSpheres::readTuples(size_t part, size_t number, LightPart lit) const {
    RELUME_CHECK(mSetOf[part][number]);
    const Set& set = *mSetOf[part][number];
    const size_t firstImage = size_t(lit) * mTupleImages + set.firstImage;
    const std::vector<vec4> texels = readImage(mDevice, mTuples);
    std::vector<vec3> tuples;
    for (size_t texel = 0; texel < size_t(set.rows()) * kTupleAzimuths; texel++)
        for (size_t value = 0; value < 3 * size_t(set.terms); value += 3) {
            const auto at = [&](size_t i) {
                return texels[(firstImage + i / 4) * mTupleRows * kTupleAzimuths + texel][int(i % 4)];
            };
            tuples.emplace_back(at(value), at(value + 1), at(value + 2));
        }
    return tuples;
}

} // namespace relume
