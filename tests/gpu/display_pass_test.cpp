// What a window shows, held against toneMap().
#include "engine/render/display_pass.h"
#include "engine/vk/upload.h"
#include "tests/support/test_device.h"

#include <cmath>
#include <limits>
#include <random>

using namespace relume;

namespace {

constexpr float kBackground = 0.2f;

// Radiance over twenty stops; pixels that are not covered, negative, endless or no numbers.
Image sampleImage() {
    Image image(61, 47);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> stops(-12, 8);
    for (vec4& pixel : image.pixels) {
        for (int c = 0; c < 3; c++) pixel[c] = std::exp2(stops(random));
        pixel.w = random() % 5 ? 1.0f : 0.0f;
    }
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    image.pixels[0] = {-1, kInfinity, std::numeric_limits<float>::quiet_NaN(), 1};
    image.pixels[1] = {0, 1e30f, -kInfinity, 1};
    image.pixels[2] = {1e-30f, 0.18f, 1, 1};
    return image;
}

Image displayed(const vk::Device& device, const Image& image, const DisplayOptions& options) {
    const uint32_t width = uint32_t(image.width), height = uint32_t(image.height);
    const vk::Image view =
        vk::uploadImage(device,
                        {.width = width,
                         .height = height,
                         .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                  VK_IMAGE_USAGE_TRANSFER_SRC_BIT},
                        std::as_bytes(std::span(image.pixels)), "view");
    constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;
    const vk::Image target(device,
                           {.format = kFormat,
                            .width = width,
                            .height = height,
                            .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT},
                           "target");
    const DisplayPass pass(device, kFormat);
    const vk::Buffer readback(device, 4 * width * height, vk::BufferUse::Readback, "readback");
    vk::Commands commands(device, "display");
    commands.begin();
    commands.transition(view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                        vk::Stage::Transfer, vk::Stage::Transfer);
    for (int i = 0; i < 2; i++) pass.record(commands, view, target, options); // the view is as it was
    commands.transition(target, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                        VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, vk::Stage::Color, vk::Stage::Transfer);
    commands.copy(target, readback, 1);
    commands.barrier(vk::Stage::Transfer, vk::Stage::Host);
    commands.submitAndWait();
    Image shown(image.width, image.height);
    for (size_t i = 0; i < shown.pixels.size(); i++)
        for (int c = 0; c < 4; c++)
            shown.pixels[i][c] = float(readback.map<uint8_t>()[4 * i + size_t(c)]) / 255;
    return shown;
}

} // namespace

TEST_CASE("display pass: shows what tone mapping on the CPU gives, over the background") {
    const TestDevice device;
    const Image image = sampleImage();
    for (const ToneCurve curve : {ToneCurve::None, ToneCurve::Aces, ToneCurve::Agx})
        for (const float exposure : {0.0f, -2.5f, 3.0f}) {
            CAPTURE(int(curve));
            CAPTURE(exposure);
            const Image right = toneMap(image, curve, exposure);
            const Image shown = displayed(device, image, {curve, exposure, vec3(kBackground)});
            float worst = 0;
            for (size_t i = 0; i < image.pixels.size(); i++)
                for (int c = 0; c < 3; c++) {
                    const float expected = image.pixels[i].w == 0 ? kBackground : right.pixels[i][c];
                    worst = std::max(worst, std::abs(shown.pixels[i][c] - expected));
                }
            // Rounding; the shader's own logarithm and power, or lavapipe's.
            CHECK_LT(worst, 0.51f / 255 + (curve == ToneCurve::Agx ? 4e-4f : 2e-3f));
        }
}
