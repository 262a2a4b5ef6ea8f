#include "engine/render/light_pass.h"

#include "engine/base/check.h"
#include "engine/vk/upload.h"

namespace relume {

using vk::BufferUse;
using vk::Stage;

LightPass::LightPass(const vk::Device& device, int faceSize)
    : mDevice(device), mFaceSize(faceSize), mSources(device, faceSize), mTable(device, faceSize, "light"),
      mRadiance(device, coefficients() * sizeof(vec3), BufferUse::Device, "light radiance") {}

void LightPass::setLight(Light light) {
    mSources.prepare(light);
    mLight = std::move(light);
}

void LightPass::setEnvironment(const Environment& prepared) {
    setLight({.environments = {{std::make_shared<Environment>(prepared)}}});
}

void LightPass::setCube(const LightCube& cube) {
    RELUME_CHECK_EQ(cube.size, mFaceSize);
    RELUME_CHECK_EQ(cube.radiance.size(), size_t(coefficients()));
    mRadiance = vk::upload<vec3>(mDevice, cube.radiance, "light radiance");
    mHasCube = true;
    mLight.reset();
}

void LightPass::record(vk::Commands& commands, float rotation, const LightSelection& selection) {
    RELUME_CHECK(mLight || mHasCube);
    mSelection = selection;
    // An earlier frame of the same submission may still be reading the table and the stats.
    commands.barrier(Stage::Compute, Stage::Compute);
    commands.barrier(Stage::Draw, Stage::Compute);
    if (mLight) mSources.record(commands, turned(*mLight, rotation), mRadiance);
    mTable.record(commands, mRadiance, selection);
}

LightCube LightPass::readCube() const {
    return {mFaceSize, vk::download<vec3>(mDevice, mRadiance, coefficients())};
}

} // namespace relume
