#include "apps/relume/studied_light.h"

#include "engine/base/error.h"

#include <algorithm>

namespace relume {

void StudiedLightArguments::add(CLI::App& command) {
    light.add(command);
    selection.add(command);
}

StudiedLight StudiedLightArguments::studied() const {
    StudiedLight studied = sampled();
    // Checked before the work, whose errors are relative to the radiance seen.
    if (std::ranges::all_of(studied.fine.radiance, [](vec3 radiance) { return radiance == vec3(0); }))
        throw Error(
            "the light is black: under no light no error can be told; choose another, or turn a lamp on");
    return studied;
}

StudiedLight StudiedLightArguments::sampled() const {
    constexpr int kFineWidth = 2048; // as many columns per texel as the coarse cube has
    const float rotation = radians(light.rotationDegrees);
    if (!light.isEnvironment()) {
        const Light all = turned(light.light(), rotation);
        return {all, sampleLight(all, kTruthFaceSize), selection.selection()};
    }
    const Environment map = light.environment();
    const auto prepared = std::make_shared<const Environment>(prepareForSampling(map));
    return {{.environments = {{prepared, rotation}}},
            sampleEnvironment(prepareForSampling(map, kFineWidth), kTruthFaceSize, rotation),
            selection.selection()};
}

} // namespace relume
