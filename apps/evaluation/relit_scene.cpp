#include "apps/evaluation/relit_scene.h"
#include "engine/import/environment_file.h"

#include "apps/evaluation/expect_no_stop.h"
#include "engine/base/check.h"
#include "engine/base/progress.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace relume {

namespace {

constexpr int kTruthColumns = 1024;

} // namespace

SceneLight environmentLight(const SceneInput& input, float rotationDegrees) {
    const Environment map = readEnvironment(input.file);
    const float rotation = glm::radians(rotationDegrees);
    const auto prepared = std::make_shared<const Environment>(prepareForSampling(map));
    return {describe(input),
            {.environments = {{prepared, rotation}}},
            sampleEnvironment(prepareForSampling(map, kTruthColumns), kTruthFaceSize, rotation)};
}

SceneLight areaLight(float azimuth, float elevation, float radius) {
    const float angle = glm::radians(radius), sine = std::sin(angle);
    const Light light{.lamps = {{directionAt(azimuth, elevation), angle, vec3(1 / (sine * sine))}}};
    return {fmt::format("an area light of {} degrees' radius", radius), light,
            sampleLight(light, kTruthFaceSize)};
}

SceneLight distantLight(float azimuth, float elevation, int face) {
    const Light light{.distant = {{directionAt(azimuth, elevation), vec3(kPi)}}};
    return {"a distant light", light, sampleLight(light, face)};
}

Camera orbitOf(const Asset& asset, ImageSize size, float azimuth, float elevation, float distance) {
    return orbitCamera(objectBounds(asset), glm::radians(azimuth), glm::radians(elevation), distance,
                       glm::radians(35.0f), size.aspect());
}

RelitScene::RelitScene(const vk::Device& device, const Asset& asset, ImageSize size)
    : mDevice(device), mLight(device, asset.faceSize), mRelighter(device, asset, {}),
      mView(device, asset, {.width = size.width, .height = size.height, .samples = 1}) {}

Image RelitScene::render(const Camera& camera, const Light& light, const RelitOptions& options) {
    mLight.setLight(light);
    mView.setTerms(options.terms);
    mView.setResidual(options.residual);
    vk::Commands commands(mDevice, "evaluate");
    commands.begin();
    mLight.record(commands, 0, options.selection);
    mRelighter.record(commands, mLight);
    mView.record(commands, camera, mRelighter);
    commands.submitAndWait();
    return mView.read();
}

SceneReference::SceneReference(const Asset& asset, const Camera& camera, const LightCube& truth,
                               ImageSize size, ReferenceBrdf brdf)
    : mReference(asset, brdf) {
    mReference.restart(camera, truth, defaultAppearance(asset), size.width, size.height, 1);
}

void SceneReference::refine(const std::vector<Image>& images, const ReferenceEffort& effort) {
    RELUME_CHECK(effort.fewest >= 2 && !images.empty());
    Progress progress("reference", uint64_t(effort.most), "passes");
    const auto isGood = [&] {
        double least = std::numeric_limits<double>::infinity();
        for (const Image& image : images) {
            const ReferenceError error = mReference.errorOf(image).value_or(ReferenceError{});
            mNoise = error.level > 0 ? error.noise / error.level : 0;
            least = std::min(least, error.rmse / std::max(error.level, 1e-30));
        }
        return mNoise <= effort.noise * least;
    };
    for (int next = effort.fewest; mReference.passes() < effort.most;) {
        expectNoStop();
        mReference.addPass();
        progress.update(uint64_t(mReference.passes()));
        if (mReference.passes() < next) continue;
        if (isGood()) return;
        next = mReference.passes() + effort.fewest;
    }
    isGood();
}

MeasuredError SceneReference::errorOf(const Image& image) const {
    return measuredError(mReference.errorOf(image).value_or(ReferenceError{}));
}

} // namespace relume
