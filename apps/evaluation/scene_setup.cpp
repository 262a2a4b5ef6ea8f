#include "apps/evaluation/scene_setup.h"

#include "engine/base/check.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace relume {

namespace {

constexpr size_t kQuickTriangles = 5000;
constexpr int kQuickGround = 40; // quads a side
constexpr int kQuickVisibility = 128;

// Quads a side: the paper's 22, 31, 63 and 23 thousand vertices.
int groundOf(const std::string& model) {
    static const std::map<std::string, int> kQuads = {
        {"bunny", 148}, {"buddha", 175}, {"dragon", 250}, {"lucy", 151}};
    return kQuads.at(model);
}

} // namespace

BakeRecipe sceneRecipe(const SectionInputs& inputs, const std::string& model, const SceneInput& found,
                       const std::string& material, const BakeOptions& options) {
    BakeRecipe recipe{describe(found), found, material, GroundOptions{.tessellation = groundOf(model)},
                      options};
    if (inputs.quick) {
        recipe.triangles = kQuickTriangles;
        recipe.ground->tessellation = kQuickGround;
        recipe.options.visibilitySize = kQuickVisibility;
        recipe.options.transportSamples =
            std::min(recipe.options.transportSamples, recipe.options.mostTransportSamples());
    }
    return recipe;
}

std::vector<SceneInput> environmentsOf(const SectionInputs& inputs, std::span<const char* const> names) {
    std::vector<SceneInput> found;
    for (const char* name : names)
        if (const auto environment = inputs.scenes.environment(name)) found.push_back(*environment);
    return found;
}

ImageSize wideImage(bool quick) { return quick ? ImageSize{320, 240} : ImageSize{640, 480}; }
ImageSize tallImage(bool quick) { return quick ? ImageSize{240, 320} : ImageSize{480, 640}; }

Section skippedSection(Section section, const std::string& why) {
    section.write = [why](const StepResults&, ReportSection& report) { report.say("Skipped: " + why + "."); };
    return section;
}

ReferenceEffort referenceEffort(bool quick) {
    return quick ? ReferenceEffort{.noise = 0.3, .fewest = 16, .most = 64} : ReferenceEffort{};
}

std::string quickNote(bool quick) {
    if (!quick) return "";
    return fmt::format(
        "With --quick: models simplified to {} triangles on grounds of {} vertices, visibility at "
        "6 x {}² instead of 6 x 256², images of a quarter of the pixels, fewer samples.",
        kQuickTriangles, (kQuickGround + 1) * (kQuickGround + 1), kQuickVisibility);
}

} // namespace relume
