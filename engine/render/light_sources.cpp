#include "engine/render/light_sources.h"

#include "engine/base/error.h"
#include "engine/light/light_footprint.h"
#include "engine/vk/upload.h"
#include "shaders/light_distant_comp.h"
#include "shaders/light_lamp_gains_comp.h"
#include "shaders/light_lamps_comp.h"
#include "shaders/light_sample_comp.h"
#include "shaders/light_sky_comp.h"
#include "shaders/light_strokes_comp.h"

#include <algorithm>
#include <bit>
#include <fmt/core.h>

namespace relume {

using vk::BufferUse;
using vk::Stage;

namespace {

// Caps per dispatch: software devices end an invocation's loops after 65,535 iterations, and a cap's
// sub-cells take up to 272.
constexpr uint32_t kCapsPerDispatch = 128;

template <typename T>
void send(vk::Commands& commands, const vk::Buffer& buffer, const std::vector<T>& values) {
    commands.barrier(Stage::Compute, Stage::Transfer);
    commands.update(buffer, std::as_bytes(std::span(values)));
    commands.barrier(Stage::Transfer, Stage::Compute);
}

} // namespace

LightSources::LightSources(const vk::Device& device, int faceSize) : mDevice(device), mFaceSize(faceSize) {
    mSampleProgram = vk::ComputeProgram(device, light_sample_comp_spirv, {}, "light sample");
    mSkyProgram = vk::ComputeProgram(device, light_sky_comp_spirv, {}, "light sky");
    mStrokesProgram = vk::ComputeProgram(device, light_strokes_comp_spirv, {}, "light strokes");
    mLampGainsProgram = vk::ComputeProgram(device, light_lamp_gains_comp_spirv, {}, "light lamp gains");
    mLampsProgram = vk::ComputeProgram(device, light_lamps_comp_spirv, {}, "light lamps");
    mDistantProgram = vk::ComputeProgram(device, light_distant_comp_spirv, {}, "light distant");
    const auto buffer = [&](uint64_t bytes, const char* name) {
        return vk::Buffer(device, (kMostSources + 1) * bytes, BufferUse::Device, name);
    };
    mStrokes = buffer(sizeof(shared::LightCap), "light strokes");
    mLamps = buffer(sizeof(shared::LightCap), "light lamps");
    mLampGains = buffer(sizeof(float), "light lamp gains");
    mTaps = buffer(4 * sizeof(shared::LightTap), "light distant taps");
}

void LightSources::prepare(const Light& light) {
    RELUME_CHECK_LE(std::max({light.strokes.size(), light.lamps.size(), light.distant.size()}), kMostSources);
    std::vector<Map> maps;
    for (const EnvironmentLight& environment : light.environments) {
        const auto known = [&](const Map& map) { return map.environment == environment.map; };
        if (std::ranges::any_of(maps, known)) continue;
        if (const auto last = std::ranges::find_if(mMaps, known); last != mMaps.end())
            maps.push_back(std::move(*last));
        else
            maps.push_back(upload(environment.map, maps));
    }
    mMaps = std::move(maps);
}

LightSources::Map LightSources::upload(std::shared_ptr<const Environment> environment,
                                       const std::vector<Map>& others) const {
    const ivec2 size{environment->width, environment->height};
    RELUME_CHECK(size.x > 0 && size.y > 0);
    RELUME_CHECK_EQ(environment->radiance.size(), size_t(size.x) * size_t(size.y));
    Map map;
    for (const std::vector<Map>* list : {&others, &mMaps})
        for (const Map& other : *list)
            if (other.footprints && other.footprints->mapSize == size) map.footprints = other.footprints;
    if (!map.footprints) {
        const LightFootprints footprints = makeLightFootprints(size.x, size.y, mFaceSize);
        map.footprints = std::make_shared<Footprints>(Footprints{
            size, vk::upload<uint32_t>(mDevice, footprints.starts, "light footprint starts"),
            vk::upload<shared::FootprintPixel>(mDevice, footprints.pixels, "light footprint pixels")});
    }
    std::vector<vec4> pixels;
    pixels.reserve(environment->radiance.size());
    for (const vec3& radiance : environment->radiance) pixels.emplace_back(radiance, 0);
    map.pixels = vk::upload<vec4>(mDevice, pixels, "environment");
    const uint64_t entries = map.footprints->pixels.bytes() / sizeof(shared::FootprintPixel);
    if (pixels.size() > mDevice.mostTexels(sizeof(vec4)) ||
        entries > mDevice.mostTexels(sizeof(shared::FootprintPixel)))
        throw Error(fmt::format(
            "environment: {} x {} pixels are more than {} can bind; prepare it at a smaller width", size.x,
            size.y, mDevice.name()));
    map.environment = std::move(environment);
    return map;
}

void LightSources::record(vk::Commands& commands, const Light& light, const vk::Buffer& radiance) const {
    commands.pass("light sample", [&] {
        if (light.environments.empty()) {
            commands.barrier(Stage::Compute, Stage::Transfer);
            commands.fill(radiance, 0);
            commands.barrier(Stage::Transfer, Stage::Compute);
        }
        for (const EnvironmentLight& environment : light.environments)
            sample(commands, environment, &environment == &light.environments.front(), radiance);
    });
    if (light.sky) commands.pass("light sky", [&] { addSky(commands, *light.sky, radiance); });
    if (!light.strokes.empty())
        commands.pass("light strokes", [&] { paint(commands, light.strokes, radiance); });
    if (const std::vector<Lamp> lamps = lampsAndSun(light); !lamps.empty())
        commands.pass("light lamps", [&] { addLamps(commands, lamps, radiance); });
    if (!light.distant.empty())
        commands.pass("light distant", [&] { addDistant(commands, light.distant, radiance); });
}

void LightSources::sample(vk::Commands& commands, const EnvironmentLight& environment, bool isFirst,
                          const vk::Buffer& radiance) const {
    const auto map = std::ranges::find(mMaps, environment.map, &Map::environment);
    RELUME_CHECK(map != mMaps.end());
    const int width = environment.map->width;
    const ColumnShift shift = columnShift(environment.rotation, width);
    const shared::LightSamplePush push{texels(),       uint32_t(width),  shift.whole,
                                       shift.fraction, environment.gain, isFirst};
    commands.dispatch(mSampleProgram,
                      {vk::Binding::texelsOf(map->pixels, VK_FORMAT_R32G32B32A32_SFLOAT),
                       map->footprints->starts,
                       vk::Binding::texelsOf(map->footprints->pixels, VK_FORMAT_R32G32_UINT), radiance},
                      push, {texels(), 1, 1});
    commands.barrier(Stage::Compute, Stage::Compute);
}

void LightSources::addSky(vk::Commands& commands, const DaySky& sky, const vk::Buffer& radiance) const {
    shared::LightSky model = makeSkyModel(sky);
    model.sideBits = uint32_t(std::countr_zero(unsigned(mFaceSize)));
    commands.dispatch(mSkyProgram, {radiance}, model, {texels(), 1, 1});
    commands.barrier(Stage::Compute, Stage::Compute);
}

void LightSources::paint(vk::Commands& commands, const std::vector<Stroke>& strokes,
                         const vk::Buffer& radiance) const {
    std::vector<shared::LightCap> caps;
    for (const Stroke& stroke : strokes) caps.push_back(makeStrokeCap(stroke, mFaceSize));
    send(commands, mStrokes, caps);
    shared::LightCapsPush push{uint32_t(std::countr_zero(unsigned(mFaceSize))), 0, 0};
    for (; push.first < caps.size(); push.first += kCapsPerDispatch) {
        push.count = std::min(kCapsPerDispatch, uint32_t(caps.size()) - push.first);
        commands.dispatch(mStrokesProgram, {mStrokes, radiance}, push, {texels(), 1, 1});
        commands.barrier(Stage::Compute, Stage::Compute);
    }
}

void LightSources::addLamps(vk::Commands& commands, const std::vector<Lamp>& lamps,
                            const vk::Buffer& radiance) const {
    std::vector<shared::LightCap> caps;
    for (const Lamp& lamp : lamps) caps.push_back(makeLampCap(lamp, mFaceSize));
    send(commands, mLamps, caps);
    shared::LightCapsPush push{uint32_t(std::countr_zero(unsigned(mFaceSize))), 0, uint32_t(caps.size())};
    commands.dispatch(mLampGainsProgram, {mLamps, mLampGains}, push, {1, push.count, 1});
    commands.barrier(Stage::Compute, Stage::Compute);
    for (; push.first < caps.size(); push.first += kCapsPerDispatch) {
        push.count = std::min(kCapsPerDispatch, uint32_t(caps.size()) - push.first);
        commands.dispatch(mLampsProgram, {mLamps, mLampGains, radiance}, push, {texels(), 1, 1});
        commands.barrier(Stage::Compute, Stage::Compute);
    }
}

void LightSources::addDistant(vk::Commands& commands, const std::vector<DistantLight>& distant,
                              const vk::Buffer& radiance) const {
    const std::vector<shared::LightTap> taps = distantTaps(distant, mFaceSize);
    send(commands, mTaps, taps);
    const shared::LightDistantPush push{uint32_t(taps.size())};
    commands.dispatch(mDistantProgram, {mTaps, radiance}, push, {push.taps, 1, 1});
    commands.barrier(Stage::Compute, Stage::Compute);
}

} // namespace relume
