#include "apps/evaluation/step_run.h"

#include "apps/evaluation/evaluation_folder.h"
#include "engine/import/image_file.h"
#include "engine/render/tone_map.h"

namespace relume {

std::filesystem::path pictureOf(const std::string& step, const std::string& name) {
    return std::filesystem::path("images") / step / name;
}

StepRun::StepRun(const vk::Device& opened, const BakeStore& bakes, std::filesystem::path folder,
                 std::string step)
    : device(opened), mBakes(bakes), mFolder(std::move(folder)), mStep(std::move(step)) {}

Asset StepRun::asset(const BakeRecipe& recipe) const {
    mBakes.make(recipe);
    return mBakes.read(recipe);
}

Image StepRun::image(const std::string& step, const std::string& name) const {
    return readImage(mFolder / pictureOf(step, name + ".exr")).image;
}

std::string StepRun::place(const std::string& file) {
    const std::filesystem::path path = pictureOf(mStep, file);
    makeFolder((mFolder / path).parent_path());
    mFiles.push_back(path.string());
    return (mFolder / path).string();
}

void StepRun::writeLinear(const std::string& name, const Image& linear) {
    writeExr(place(name + ".exr"), linear);
}

void StepRun::writeToned(const std::string& name, const Image& linear, float exposure) {
    writeDisplay(name, toneMap(linear, ToneCurve::Aces, exposure));
}

void StepRun::write(const std::string& name, const Image& linear, float exposure) {
    writeLinear(name, linear);
    writeToned(name, linear, exposure);
}

void StepRun::writeDisplay(const std::string& name, const Image& display) {
    // The page is white, and so is what nothing covers.
    Image shown = display;
    for (vec4& pixel : shown.pixels) pixel = glm::mix(vec4(1), vec4(vec3(pixel), 1), pixel.w);
    writePng(place(name + ".png"), shown);
}

} // namespace relume
