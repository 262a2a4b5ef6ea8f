#include "apps/relume/studied_light.h"

namespace relume {

void StudiedLightArguments::add(CLI::App& command) {
    light.add(command);
    selection.add(command);
}

StudiedLight StudiedLightArguments::studied() const {
    const float rotation = radians(light.rotationDegrees);
    StudiedLight studied{turned(light.light(), rotation), {}, selection.selection};
    constexpr int kFineWidth = 2048; // as many columns for a fine cube as the default has for a coarse one
    studied.fine =
        light.isEnvironment()
            ? sampleEnvironment(prepareForSampling(light.environment(), kFineWidth), kTruthFaceSize, rotation)
            : sampleLight(studied.light, kTruthFaceSize);
    return studied;
}

} // namespace relume
