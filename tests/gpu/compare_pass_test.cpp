// Two images in one, held against what they are.
#include "engine/image/image.h"
#include "engine/render/compare.h"
#include "engine/render/compare_pass.h"
#include "engine/vk/upload.h"
#include "tests/support/test_device.h"

#include <random>

using namespace relume;

namespace {

constexpr int kCompareWidth = 37, kCompareHeight = 21;

Image randomImage(uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(0, 2);
    Image image(kCompareWidth, kCompareHeight);
    for (vec4& pixel : image.pixels)
        pixel = {value(random), value(random), value(random), float(random() % 2)};
    return image;
}

Image compared(const vk::Device& device, const Image& first, const Image& second,
               const CompareOptions& options) {
    const vk::ImageOptions uploaded{.width = kCompareWidth,
                                    .height = kCompareHeight,
                                    .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                             VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    const vk::Image a = vk::uploadImage(device, uploaded, std::as_bytes(std::span(first.pixels)), "first");
    const vk::Image b = vk::uploadImage(device, uploaded, std::as_bytes(std::span(second.pixels)), "second");
    ComparePass pass(device);
    const vk::Buffer readback(device, 16 * kCompareWidth * kCompareHeight, vk::BufferUse::Readback,
                              "readback");
    vk::Commands commands(device, "compare");
    commands.begin();
    for (const vk::Image* image : {&a, &b})
        commands.transition(*image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                            VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, vk::Stage::Transfer, vk::Stage::Transfer);
    for (int i = 0; i < 2; i++) pass.record(commands, a, b, options); // the images are as they were
    commands.copy(pass.image(), readback, 1);
    commands.barrier(vk::Stage::Transfer, vk::Stage::Host);
    commands.submitAndWait();
    Image image(kCompareWidth, kCompareHeight);
    std::ranges::copy(readback.map<vec4>(), image.pixels.begin());
    return image;
}

} // namespace

TEST_CASE("compare pass: one image left of the split, the other right of it") {
    const TestDevice device;
    const Image first = randomImage(1), second = randomImage(2);
    for (const float split : {0.0f, 0.4f, 1.0f}) {
        const Image both = compared(device, first, second, {CompareMode::Split, split});
        for (int y = 0; y < kCompareHeight; y++)
            for (int x = 0; x < kCompareWidth; x++)
                CHECK(both.at(x, y) ==
                      (float(x) + 0.5f < split * float(kCompareWidth) ? first.at(x, y) : second.at(x, y)));
    }
}

TEST_CASE("compare pass: differences are as hot as they are large") {
    const TestDevice device;
    const Image first = randomImage(1), second = randomImage(2);
    const Image heat = compared(device, first, second, {CompareMode::Difference, 0, 0.7f});
    for (size_t i = 0; i < heat.pixels.size(); i++) {
        const vec3 apart = glm::abs(vec3(first.pixels[i]) - vec3(second.pixels[i]));
        const vec3 expected = heatColor(0.7f * (apart.x + apart.y + apart.z) / 3);
        CHECK_LT(glm::distance(vec3(heat.pixels[i]), expected), 1e-5f);
        CHECK(heat.pixels[i].w == std::max(first.pixels[i].w, second.pixels[i].w));
    }
    CHECK(heatColor(0) == vec3(0));
    CHECK(heatColor(7) == heatColor(1));
    CHECK_LT(glm::dot(heatColor(0.3f), vec3(1)), glm::dot(heatColor(0.8f), vec3(1)));
}
