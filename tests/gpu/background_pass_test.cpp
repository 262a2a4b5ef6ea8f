// What is seen behind the object, held against its CPU twin.
#include "engine/render/background_pass.h"
#include "engine/vk/upload.h"
#include "tests/support/capture_binding.h"
#include "tests/support/test_device.h"

#include <cmath>
#include <random>

using namespace relume;

namespace {

EnvironmentLight lightOf(int width, float rotation, float gain) {
    const auto sky = std::make_shared<const Environment>(makeSky(width));
    return {sky, rotation, gain, sky};
}

std::vector<std::pair<const char*, Light>> lights() {
    const EnvironmentLight narrow = lightOf(256, 0.3f, 0.7f), wide = lightOf(2048, -1, 1.5f);
    const Stroke stroke{
        .direction = {1, 0.4f, 0.6f}, .angularRadius = 0.4f, .radiance = {4, 2, 1}, .opacity = 0.8f};
    const Stroke hard{
        .direction = {0.9f, 0, 0.2f}, .angularRadius = 0.1f, .radiance = {0, 0, 3}, .softness = 0};
    const DaySky day{.sun = glm::normalize(vec3(0.5f, 0.15f, 0.4f)), .turbidity = 4};
    return {{"nothing", {}},
            {"one", {.environments = {narrow}}},
            {"wide", {.environments = {wide}}},
            {"blend", {.environments = {narrow, wide}}},
            {"day", {.environments = {}, .sky = day}},
            {"all", {.environments = {narrow, wide}, .sky = day, .strokes = {stroke, hard}}}};
}

// Covered, half covered and empty pixels.
Image sampleView() {
    Image view(97, 53);
    std::mt19937 random(5);
    for (vec4& pixel : view.pixels) {
        const float alpha = float(random() % 3) / 2;
        pixel = alpha * vec4(random() % 4, random() % 4, random() % 4, 1);
    }
    return view;
}

vk::Image upload(const vk::Device& device, const Image& image) {
    return vk::uploadImage(device,
                           {.width = uint32_t(image.width),
                            .height = uint32_t(image.height),
                            .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                     VK_IMAGE_USAGE_TRANSFER_SRC_BIT},
                           std::as_bytes(std::span(image.pixels)), "view");
}

// Of display values, after a simple curve: the sun is not to drown the rest.
double meanDistance(const Image& a, const Image& b) {
    double sum = 0;
    for (size_t i = 0; i < a.pixels.size(); i++)
        for (int c = 0; c < 3; c++) {
            const auto shown = [&](const Image& image) {
                return image.pixels[i][c] / (1 + image.pixels[i][c]);
            };
            sum += double(std::abs(shown(a) - shown(b)));
        }
    return sum / double(3 * a.pixels.size());
}

} // namespace

TEST_CASE("background pass: draws what its CPU twin draws") {
    const TestDevice device;
    const Image view = sampleView();
    BackgroundPass pass(device);
    const Camera camera{vec3(0, 0.3f, 0), vec3(1, 0.4f, 0.8f), 1.2f};
    std::vector<Image> seen;
    for (const auto& [name, light] : lights())
        for (const float deviation : {0.0f, 0.15f}) {
            CAPTURE_BINDING(name);
            CAPTURE(deviation);
            const vk::Image source = upload(device, view);
            pass.setLight(light, deviation);
            vk::Commands commands(device, "background");
            commands.begin();
            commands.transition(source, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, vk::Stage::Transfer,
                                vk::Stage::Transfer);
            for (int i = 0; i < 2; i++) pass.record(commands, source, camera, 0.4f); // the view is as it was
            commands.submitAndWait();
            const Image drawn = pass.read();
            Image right = view;
            drawBackground(right, makeBackground(light, deviation), camera, 0.4f);
            CHECK_LT(meanDistance(drawn, right), 1e-3);
            float worst = 0; // of what is covered whole, and of alpha
            for (size_t i = 0; i < view.pixels.size(); i++) {
                worst = std::max(worst, std::abs(drawn.pixels[i].w - 1));
                if (view.pixels[i].w < 1) continue;
                for (int c = 0; c < 3; c++)
                    worst = std::max(worst, std::abs(drawn.pixels[i][c] - view.pixels[i][c]));
            }
            CHECK_EQ(worst, 0);
            for (const Image& other : seen)
                if (deviation == 0)
                    CHECK_GT(meanDistance(drawn, other), 5e-3); // each light looks its own way
            if (deviation == 0) seen.push_back(drawn);
        }
}
