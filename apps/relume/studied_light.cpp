#include "apps/relume/studied_light.h"

namespace relume {

void StudiedLightArguments::add(CLI::App& command) {
    light.add(command);
    selection.add(command);
}

StudiedLight StudiedLightArguments::studied() const {
    constexpr int kFineWidth = 2048; // as many columns for a fine cube as the default has for a coarse one
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
