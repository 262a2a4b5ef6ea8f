#include "apps/evaluation/figure_steps.h"

#include "apps/evaluation/expect_no_stop.h"
#include "engine/base/check.h"
#include "engine/render/heat_color.h"
#include "engine/render/tone_map.h"
#include "precompute/reference/reference_image.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace relume {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kHeatRange = 0.5; // of the reference's mean luminance: yellow

Json describe(const FigureSetup& setup) {
    return {{"size", {setup.size.width, setup.size.height}},
            {"orbit", {setup.azimuth, setup.elevation, setup.distance}},
            {"light", setup.light.key}};
}

Json describe(const RelitOptions& options) {
    Json json = {{"terms", options.terms}};
    if (options.selection.threshold)
        json["threshold"] = *options.selection.threshold;
    else
        json["count"] = options.selection.count;
    return json;
}

std::string renderStep(const FigureSetup& setup, size_t image) {
    return setup.name + "-" + setup.images[image].name;
}
std::string referenceStep(const FigureSetup& setup) { return setup.name + "-reference"; }

// The first image of the bake that this one is of.
size_t firstOfBake(const FigureSetup& setup, size_t image) {
    const Json key = setup.images[image].recipe.key();
    for (size_t i = 0; i < image; i++)
        if (setup.images[i].recipe.key() == key) return i;
    return image;
}

Camera cameraOf(const FigureSetup& setup, const Asset& asset) {
    return orbitOf(asset, setup.size, setup.azimuth, setup.elevation, setup.distance);
}

float luminance(vec3 radiance) { return glm::dot(radiance, vec3(0.2126f, 0.7152f, 0.0722f)); }

std::vector<float> luminances(const Image& image) {
    std::vector<float> values;
    for (const vec4& pixel : image.pixels)
        if (pixel.w > 0) values.push_back(luminance(vec3(pixel)));
    return values;
}

// Stops that show nine tenths of the covered pixels at or below a bright grey.
float exposureOf(const Image& reference) {
    constexpr float kBright = 0.6f;
    std::vector<float> values = luminances(reference);
    if (values.empty()) return 0;
    const auto tenth = values.begin() + ptrdiff_t(values.size() * 9 / 10);
    std::nth_element(values.begin(), tenth, values.end());
    return *tenth > 0 ? std::log2(kBright / *tenth) : 0;
}

Image heatOf(const Image& image, const Image& reference) {
    const std::vector<float> values = luminances(reference);
    double sum = 0;
    for (const float value : values) sum += double(value);
    const double range = kHeatRange * std::max(1e-30, sum / double(std::max<size_t>(1, values.size())));
    Image heat(image.width, image.height);
    for (size_t i = 0; i < image.pixels.size(); i++) {
        if (reference.pixels[i].w == 0) continue;
        const vec3 difference = glm::abs(vec3(image.pixels[i]) - vec3(reference.pixels[i]));
        heat.pixels[i] = vec4(heatColor(float(double(luminance(difference)) / range)), 1);
    }
    return toneMap(heat, ToneCurve::None, 0);
}

// Draws all images of the bake of image `first`.
Step makeRenderStep(const FigureSetup& setup, size_t first) {
    Step step;
    step.name = renderStep(setup, first);
    step.title = fmt::format("{}: {}", setup.title, setup.images[first].title);
    step.seconds = setup.seconds;
    step.inputs = describe(setup);
    step.bakes = {setup.images[first].recipe};
    for (size_t i = first; i < setup.images.size(); i++)
        if (firstOfBake(setup, i) == first)
            step.inputs["images"][setup.images[i].name] = describe(setup.images[i].relit);
    step.work = [setup, first](StepRun& run) {
        const BakeRecord record = run.bake(setup.images[first].recipe);
        const Asset asset = run.asset(setup.images[first].recipe);
        const SceneLight light = setup.light.make();
        RelitScene scene(run.device, asset, setup.size);
        for (size_t i = first; i < setup.images.size(); i++) {
            if (firstOfBake(setup, i) != first) continue;
            RelitOptions relit = setup.images[i].relit;
            relit.residual = !isPublished(setup.images[i].recipe.options.factorization.method);
            run.writeLinear(setup.images[i].name, scene.render(cameraOf(setup, asset), light.light, relit));
        }
        return Json{{"bytes_per_vertex", double(record.bytes) / double(record.vertices)},
                    {"vertices", record.vertices}};
    };
    return step;
}

// Holds the images, as many as the setup has, against the reference. The asset's transport is not used.
Json compare(const FigureSetup& setup, StepRun& run, const Asset& asset, const std::vector<Image>& images) {
    std::vector<Image> compared;
    for (size_t i = 0; i < setup.images.size(); i++)
        if (setup.images[i].isCompared) compared.push_back(images[i]);
    SceneReference reference(asset, cameraOf(setup, asset), setup.light.make().truth, setup.size);
    reference.refine(compared, setup.effort);
    const Image truth = reference.mean();
    const float exposure = exposureOf(truth);
    run.write("reference", truth, exposure);
    Json numbers = {{"passes", reference.passes()},
                    {"noise", reference.noise()},
                    {"exposure", exposure},
                    {"errors", Json::object()}};
    for (size_t i = 0; i < images.size(); i++) {
        const FigureImage& image = setup.images[i];
        if (image.isShown) run.writeToned(image.name, images[i], exposure);
        if (!image.isCompared) continue;
        numbers["errors"][image.name] = reference.errorOf(images[i]);
        if (setup.showsErrors && image.isShown)
            run.writeDisplay(image.name + "-error", heatOf(images[i], truth));
    }
    return numbers;
}

// The asset with the first terms of all of its BRDFs, of one layer each.
Asset withTerms(Asset asset, int terms) {
    RELUME_CHECK_LT(0, terms);
    for (AssetPart& part : asset.parts)
        for (MaterialSet& set : part.sets) {
            FactoredBrdf& brdf = set.brdf;
            RELUME_CHECK_EQ(brdf.layers, 1);
            brdf.terms = std::min(brdf.terms, terms);
            brdf.lightMaps.resize(size_t(brdf.terms) * brdf.mapTexels());
            brdf.viewMaps.resize(size_t(brdf.terms) * brdf.mapTexels());
            brdf.eigenvalues.resize(size_t(brdf.terms));
        }
    return asset;
}

// An image with rays for transport, and terms for the BRDF. Its rays are on a grid, and have no noise.
Image traceTerms(const FigureSetup& setup, const Asset& whole, int terms, const LightCube& light) {
    expectNoStop();
    const Asset asset = withTerms(whole, terms);
    return renderReference(asset, cameraOf(setup, asset), light,
                           {.width = setup.size.width,
                            .height = setup.size.height,
                            .brdf = ReferenceBrdf::Factored,
                            .raysPerTexelSide = 4});
}

// That of a setup which holds images against a reference: all but its work and what that needs.
Step comparingStep(const FigureSetup& setup, const char* what) {
    Step step;
    step.name = referenceStep(setup);
    step.title = fmt::format("{}: {}", setup.title, what);
    step.seconds = setup.seconds;
    step.inputs = describe(setup);
    step.inputs["effort"] = {setup.effort.noise, setup.effort.fewest, setup.effort.most};
    return step;
}

// Makes a light when it is first asked for, and keeps it.
std::function<SceneLight()> onlyOnce(const std::function<SceneLight()>& make) {
    return [make, kept = std::make_shared<std::optional<SceneLight>>()] {
        if (!*kept) *kept = make();
        return **kept;
    };
}

} // namespace

LightChoice environmentChoice(const SceneInput& input, float rotationDegrees) {
    return {{{"environment", input.hash}, {"rotation", rotationDegrees}},
            onlyOnce([=] { return environmentLight(input, rotationDegrees); })};
}

LightChoice areaChoice(float azimuth, float elevation, float radius) {
    return {{{"area", {azimuth, elevation, radius}}},
            onlyOnce([=] { return areaLight(azimuth, elevation, radius); })};
}

LightChoice distantChoice(float azimuth, float elevation, int face) {
    return {{{"distant", {azimuth, elevation, face}}},
            onlyOnce([=] { return distantLight(azimuth, elevation, face); })};
}

std::vector<Step> figureSteps(const FigureSetup& setup) {
    std::vector<Step> steps;
    for (size_t i = 0; i < setup.images.size(); i++)
        if (firstOfBake(setup, i) == i) steps.push_back(makeRenderStep(setup, i));
    Step step = comparingStep(setup, "reference");
    step.bakes = {setup.images[setup.truth].recipe};
    for (const Step& render : steps) step.after.push_back(render.name);
    step.work = [setup](StepRun& run) {
        std::vector<Image> images;
        for (size_t i = 0; i < setup.images.size(); i++)
            images.push_back(run.image(renderStep(setup, firstOfBake(setup, i)), setup.images[i].name));
        return compare(setup, run, run.asset(setup.images[setup.truth].recipe), images);
    };
    steps.push_back(std::move(step));
    return steps;
}

Step tracedFigureStep(const FigureSetup& setup) {
    Step step = comparingStep(setup, "terms alone");
    step.inputs["recipe"] = setup.images.front().recipe.key();
    for (const FigureImage& image : setup.images) step.inputs["terms"].push_back(image.relit.terms);
    step.work = [setup](StepRun& run) {
        const BakeRecipe& recipe = setup.images.front().recipe;
        BakeObserver silent;
        const Asset asset = planBake(run.device, makeScene(recipe), recipe.options, silent).asset;
        const LightCube light = setup.light.make().truth;
        std::vector<Image> images;
        for (const FigureImage& image : setup.images)
            images.push_back(traceTerms(setup, asset, image.relit.terms, light));
        return compare(setup, run, asset, images);
    };
    return step;
}

MeasuredError errorOf(const FigureSetup& setup, const StepResults& results, const std::string& image) {
    return results.at(referenceStep(setup)).numbers.at("errors").at(image).get<MeasuredError>();
}

ReportFigure figureOf(const FigureSetup& setup, const StepResults& results, const std::string& title) {
    const std::string step = referenceStep(setup);
    const Json& numbers = results.at(step).numbers;
    ReportFigure figure{title, 0, {}, ""};
    std::vector<Picture> errors;
    for (const FigureImage& image : setup.images) {
        if (!image.isShown) continue;
        const std::string error = image.isCompared ? textOf(errorOf(setup, results, image.name)) : "";
        figure.pictures.push_back({pictureOf(step, image.name + ".png"), image.title, error});
        if (image.isCompared)
            errors.push_back({pictureOf(step, image.name + "-error.png"), "", "error of " + image.title});
    }
    figure.pictures.push_back({pictureOf(step, "reference.png"), "reference",
                               fmt::format("{} samples a pixel", numbers.at("passes").get<int>())});
    figure.columns = int(figure.pictures.size()); // errors below the images that they are of
    figure.note = fmt::format("Exposure {:+.1f} stops; noise left in the reference {:.2f} %.",
                              numbers.at("exposure").get<double>(), 100 * numbers.at("noise").get<double>());
    if (!setup.showsErrors) return figure;
    figure.pictures.insert(figure.pictures.end(), errors.begin(), errors.end());
    figure.note += fmt::format(
        " Errors: black none, yellow {:.0f} % of the reference's mean luminance or more.", 100 * kHeatRange);
    return figure;
}

} // namespace relume
