#include "engine/render/fill_light.h"

#include "engine/base/check.h"
#include "engine/vk/upload.h"
#include "shaders/light_fill_comp.h"
#include "shaders/shared/light.h"

namespace relume {

using vk::Stage;

static uint32_t texelsOf(int faceSize) { return 6 * uint32_t(faceSize) * uint32_t(faceSize); }

FillLight::FillLight(const vk::Device& device, int faceSize)
    : mDevice(device), mFaceSize(faceSize), mProgram(device, light_fill_comp_spirv, {}, "light fill"),
      mTable(device, faceSize, "fill"),
      mRadiance(device, texelsOf(faceSize) * sizeof(vec3), vk::BufferUse::Device, "fill radiance") {}

void FillLight::record(vk::Commands& commands, const LightPass& light) {
    RELUME_CHECK_EQ(light.faceSize(), mFaceSize);
    const uint32_t texels = texelsOf(mFaceSize);
    // Passes of an earlier frame may still be reading.
    commands.barrier(Stage::Compute, Stage::Compute);
    commands.pass("light fill", [&] {
        commands.dispatch(mProgram, {light.radiance(), mRadiance},
                          shared::LightFillPush{texels, shared::kMostOfMean / float(texels)}, {1, 1, 1});
        commands.barrier(Stage::Compute, Stage::Compute);
    });
    mTable.record(commands, mRadiance, light.selection());
}

LightCube FillLight::readCube() const {
    return {mFaceSize, vk::download<vec3>(mDevice, mRadiance, texelsOf(mFaceSize))};
}

} // namespace relume
