// Turns an environment about a bake: turning_light BAKE ENVIRONMENT FRAMES writes turning_light_000.png and
// so on.
#include <cstdio>
#include <cstdlib>
#include <relume/import.h>
#include <relume/relume.h>

using namespace relume;

int main(int count, char** arguments) try {
    if (count != 4) {
        std::fprintf(stderr, "usage: turning_light BAKE ENVIRONMENT FRAMES\n");
        return 2;
    }
    constexpr int kWidth = 640, kHeight = 480;
    setLog([](LogLevel, const std::string& text) { std::fprintf(stderr, "%s\n", text.c_str()); });
    const Asset asset = readAsset(arguments[1]);
    const auto environment =
        std::make_shared<const Environment>(prepareForSampling(readEnvironment(arguments[2])));
    const int frames = std::atoi(arguments[3]);

    const vk::Device device;
    LightPass light(device, asset.faceSize);
    light.setLight({.environments = {{environment}}});
    Relighter relighter(device, asset);
    ViewPass view(device, asset, {.width = kWidth, .height = kHeight});
    const Camera camera =
        defaultCamera(objectBounds(asset), glm::radians(35.0f), float(kWidth) / float(kHeight));

    vk::Commands commands(device, "frame");
    float exposure = 0; // that of the first frame for all, so that none flickers
    for (int frame = 0; frame < frames; frame++) {
        commands.begin();
        light.record(commands, 2 * kPi * float(frame) / float(frames));
        relighter.record(commands, light);
        view.record(commands, camera, relighter);
        commands.submitAndWait();
        const Image image = view.read();
        if (frame == 0) exposure = autoExposure(image);
        char name[32];
        std::snprintf(name, sizeof name, "turning_light_%03d.png", frame);
        writePng(name, toneMap(image, ToneCurve::Agx, exposure));
        std::printf("%s\n", name);
    }
} catch (const std::exception& failure) {
    std::fprintf(stderr, "turning_light: %s\n", failure.what());
    return 1;
}
