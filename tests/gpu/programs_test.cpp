// Programs are made once for each source.
#include "engine/vk/program.h"
#include "engine/vk/shader_replacement.h"
#include "shaders/display_frag.h"
#include "shaders/display_vert.h"
#include "shaders/light_haar_comp.h"

#include <doctest/doctest.h>
#include <future>
#include <set>

using namespace relume;

namespace {

vk::ComputeProgram lightHaar(const vk::Device& device, uint32_t faceSize) {
    return {device, light_haar_comp_spirv, {faceSize}, "light haar"};
}

} // namespace

TEST_CASE("programs: those of equal shaders and constants are one, also of several threads") {
    const vk::Device device;
    std::vector<std::future<vk::ComputeProgram>> made;
    for (int i = 0; i < 4; i++)
        made.push_back(std::async(std::launch::async, [&] { return lightHaar(device, 16); }));
    std::set<VkPipeline> pipelines;
    for (auto& program : made) pipelines.insert(program.get().pipeline());
    CHECK_EQ(pipelines.size(), 1u);
    CHECK(lightHaar(device, 32).pipeline() != lightHaar(device, 16).pipeline());
}

TEST_CASE("programs: what is drawn in another way has a program of its own") {
    const vk::Device device;
    const auto display = [&](uint32_t curve, const vk::GraphicsOptions& options) {
        return vk::GraphicsProgram(device, display_vert_spirv, display_frag_spirv, {curve}, options,
                                   "display");
    };
    CHECK_EQ(display(0, {}).pipeline(), display(0, {}).pipeline());
    CHECK(display(1, {}).pipeline() != display(0, {}).pipeline());
    CHECK(display(0, {.addsColor = true}).pipeline() != display(0, {}).pipeline());
}

TEST_CASE("programs: a replaced shader makes another program, and the old one stays usable") {
    vk::Device device;
    const vk::ComputeProgram before = lightHaar(device, 16);
    std::vector<uint32_t> spirv(std::begin(light_haar_comp_spirv), std::end(light_haar_comp_spirv));
    spirv[2]++; // the number of the compiler: the same shader in other words
    CHECK_EQ(device.replaceShaders(
                 std::vector<vk::ShaderReplacement>{{"light_haar.comp", light_haar_comp_spirv, spirv}}),
             1u);
    const vk::ComputeProgram after = lightHaar(device, 16);
    CHECK(after.pipeline() != before.pipeline());
    CHECK_EQ(lightHaar(device, 16).pipeline(), after.pipeline());
    CHECK_EQ(before.name(), "light haar");
}
