#include "apps/relume/scene_arguments.h"

#include "apps/relume/bake_report.h"
#include "apps/relume/options.h"
#include "engine/base/error.h"
#include "engine/transport/asset_check.h"
#include "precompute/brdf/material_json.h"
#include "precompute/brdf/material_list.h"
#include "precompute/visibility/occluder.h"

#include <algorithm>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace relume {

std::string joinMaterials(const std::vector<std::string>& materials, bool separate) {
    if (materials.size() == 1) return materials.front();
    nlohmann::json list = nlohmann::json::array();
    for (const std::string& material : materials)
        list.push_back(looksLikeJson(material) ? parseMaterial(material) : nlohmann::json(material));
    // Bytes that are not UTF-8 are replaced, which leads to an unknown name.
    return nlohmann::json{{separate ? "separate" : "set", list}}.dump(
        -1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void SceneArguments::add(CLI::App& command) {
    command
        .add_option("INPUT", input,
                    "Mesh (.obj, .ply, .gltf, .glb), scene (.json), or built-in knot, sphere, torus, plane")
        ->capture_default_str();
    mMaterialOption = command
                          .add_option("-m,--material", mMaterials,
                                      "Preset, model, file, or JSON object with parameters; several, or a "
                                      "{\"set\": […]}, share one bake and can be swapped and blended")
                          ->type_name("MATERIAL")
                          ->allow_extra_args(false) // one each, since INPUT may follow
                          ->default_str(fmt::format("the file's own (glTF), else {}", kDefaultMaterial));
    command.add_flag("--separate", mSeparate,
                     "Bake several materials each on its own: larger, more exact, swapped but not blended");
    mUpOption = command.add_option("--up", mUp, "The mesh's up axis: y or z")
                    ->type_name("AXIS")
                    ->check(CLI::IsMember({"y", "z"}))
                    ->capture_default_str();
    mBrushOption = command
                       .add_option("--brush-rotation", mBrushRotation,
                                   "Degrees to turn brushed (anisotropic) materials on the surface, "
                                   "counter-clockwise")
                       ->type_name("DEGREES")
                       ->check(between(-kLargestBrushRotation, kLargestBrushRotation))
                       ->capture_default_str();
    command.add_flag("--ground", ground, "Put a diffuse ground under the object");
    mGroundDetails.push_back(
        command.add_option("--ground-material", mGroundMaterial, "Material of the ground")
            ->type_name("MATERIAL")
            ->capture_default_str());
    mTessellationOption =
        command
            .add_option("--ground-tessellation", mGroundOptions.tessellation, "Quads a side of the ground")
            ->type_name("QUADS")
            ->check(CLI::Range(1, kMostGroundQuads))
            ->default_str(
                fmt::format("{}; {} where it is refined", mGroundOptions.tessellation, kRefinedGroundQuads));
    mGroundDetails.push_back(mTessellationOption);
    mGroundDetails.push_back(
        command.add_option("--ground-extent", mGroundOptions.extent, "Side of the ground, in object sizes")
            ->type_name("X")
            ->check(between(kSmallestGroundExtent, kLargestGroundExtent))
            ->capture_default_str());
}

Scene SceneArguments::load(bool isRefined) const {
    Scene scene;
    GroundOptions groundOptions = mGroundOptions;
    if (isRefined && mTessellationOption->count() == 0) {
        groundOptions.tessellation = kRefinedGroundQuads;
        groundOptions.isRefinable = true;
    }
    const bool isScene = input.ends_with(".json");
    for (const CLI::Option* option : {mMaterialOption, mUpOption, mBrushOption})
        if (isScene && option->count() > 0)
            throw UsageError(fmt::format("{}: has no effect on a scene file, whose parts say it themselves",
                                         option->get_name()));
    for (const CLI::Option* option : mGroundDetails)
        if (!ground && option->count() > 0)
            throw UsageError(fmt::format("{}: needs --ground", option->get_name()));
    if (mSeparate && mMaterials.size() < 2) throw UsageError("--separate: needs several --material");
    if (isScene)
        scene = readScene(input, groundOptions);
    else
        scene.parts = loadParts(input, mUp == "z" ? UpAxis::Z : UpAxis::Y, chosenMaterial());
    if (!isScene)
        for (Part& part : scene.parts) part.brushRotation = mBrushRotation;
    if (ground) {
        for (const Part& part : scene.parts)
            if (part.name == "ground")
                throw UsageError(fmt::format("--ground: {} has a ground already", input));
        addGround(scene, groundOptions, mGroundMaterial);
    }
    checkMaterials(scene);
    return scene;
}

std::optional<std::string> SceneArguments::chosenMaterial() const {
    if (mMaterials.empty()) return hasOwnMaterials(input) ? std::nullopt : std::optional(kDefaultMaterial);
    return joinMaterials(mMaterials, mSeparate);
}

void SceneArguments::checkMaterials(const Scene& scene) const {
    for (const Part& part : scene.parts) {
        try {
            readMaterials(part.material, part.materialFolder);
        } catch (const UsageError& wrong) {
            if (!input.ends_with(".json")) throw;
            throw Error(fmt::format("{}: part \"{}\": {}", input, part.name, wrong.what()));
        }
    }
}

void addPreset(CLI::App& command, BakePreset& preset, const std::string& help) {
    std::map<std::string, BakePreset> presets;
    for (const BakePreset each : kBakePresets) presets.emplace(presetName(each), each);
    addChoice(command, "--preset", preset, presets, help)->type_name("PRESET")->default_str("default");
}

void addBounces(CLI::App& command, std::optional<int>& bounces, const std::string& standard) {
    command
        .add_option(
            "--bounces", bounces,
            fmt::format("Reflections between surfaces that light may take before the last: 0, direct light "
                        "alone, to {}. Surfaces light others as they look in the first material of each "
                        "part, or painted",
                        kMostBounces))
        ->type_name("B")
        ->default_str(standard);
}

void BakeArguments::add(CLI::App& command, bool takesLayout) {
    const BakeOptions defaults = presetOptions(BakePreset::Default);
    mTakesLayout = takesLayout;
    addPreset(command, mPreset,
              "Options to start from: default, or paper, the method as it was published in 2004 "
              "(docs/paper.md); options that are given win");
    mFactorization.add(command, defaults.factorization);
    const int ofRows = defaultCoefficients(TransportLayout::Rows);
    if (takesLayout) mLayout.add(command, true);
    command
        .add_option("-N,--coefficients", mCoefficients,
                    takesLayout
                        ? "Wavelet coefficients found per vertex and term: what rows keep, and what other "
                          "layouts are made from (four times as many where a material has one term)"
                        : "Wavelet coefficients kept per vertex and term")
        ->type_name("N")
        ->default_str(takesLayout ? fmt::format("{}, of rows {}", defaults.coefficients, ofRows)
                                  : fmt::format("{}", ofRows));
    const auto addSize = [&](const char* name, std::optional<int>& size, const char* type, int standard,
                             const char* help) {
        command.add_option(name, size, help)->type_name(type)->default_str(fmt::format("{}", standard));
    };
    addSize("--map-size", mMapSize, "S", defaults.mapSize, "Side of a light or view map");
    addSize("--face-size", mFaceSize, "F", defaults.faceSize,
            "Side of a face of the lighting cube: 32 or 64");
    addSize("--visibility-size", mVisibilitySize, "V", defaults.visibilitySize,
            "Side of a face of the visibility cube: 64, 128 or 256");
    command
        .add_option(
            "--visibility", mVisibility,
            "How visibility is found: traced (by rays; by drawing where the device cannot) or raster (by "
            "drawing)")
        ->type_name("METHOD")
        ->check(CLI::IsMember({"raster", "traced"}))
        ->default_str(std::string(visibilityMethodName(defaults.visibilityMethod)));
    addSize("--transport-samples", mTransportSamples, "COUNT", defaults.transportSamples,
            "BRDF evaluations per lighting texel: 1, 4 or 16");
    if (takesLayout) addBounces(command, mBounces, fmt::format("{}", defaults.bounces));
    command
        .add_option("--occluder", mOccluder, "Triangles that cast shadows: full, or a count to simplify to")
        ->type_name("TRIANGLES")
        ->default_str("full");
    command
        .add_option("--refine", mRefine,
                    fmt::format("Add vertices where interpolation between them would be seen, until it is "
                                "estimated to change reflected light by this share of it, root mean square "
                                "over all surfaces: {} to {}, 0.01 is good, 0.03 coarse; auto: so in parts "
                                "of fewer than {} vertices, to {}; off: meshes stay as they are",
                                kLeastRefinementError, kMostRefinementError, kCoarseVertices,
                                kAutoRefinementError))
        ->type_name("ERROR|auto|off")
        ->default_str("auto");
}

static std::optional<RefinementRecord> refinementOf(const std::string& text) {
    if (text == "off") return std::nullopt;
    if (text == "auto") return presetOptions(BakePreset::Default).refinement;
    RefinementRecord record;
    if (!CLI::detail::lexical_cast(text, record.wanted))
        throw UsageError(fmt::format("--refine: expected auto, off or an error of {} to {}, found \"{}\"",
                                     kLeastRefinementError, kMostRefinementError, text));
    return record;
}

static size_t occluderFrom(const std::string& text) {
    if (text == "full") return 0;
    const bool number =
        !text.empty() && text.size() < 10 && text.find_first_not_of("0123456789") == std::string::npos;
    const size_t triangles = number ? std::stoul(text) : 0;
    if (triangles < kLeastOccluderTriangles)
        throw UsageError(
            fmt::format("--occluder: expected full or a number of triangles, {} or more; found \"{}\"",
                        kLeastOccluderTriangles, text));
    return triangles;
}

void BakeArguments::resolve() {
    options = presetOptions(mPreset);
    if (!mTakesLayout) options.layout = {.layout = TransportLayout::Rows}, options.bounces = 0;
    mFactorization.resolve(options.factorization, options.mapping);
    options.factorization = mFactorization.options;
    options.mapping = mFactorization.mapping;
    options.layout = mLayout.resolve(options.layout);
    options.coefficients = mCoefficients.value_or(defaultCoefficients(options.layout.layout));
    options.mapSize = mMapSize.value_or(options.mapSize);
    options.faceSize = mFaceSize.value_or(options.faceSize);
    options.visibilitySize = mVisibilitySize.value_or(options.visibilitySize);
    if (mBounces) options.bounces = *mBounces, options.areBouncesAuto = false;
    options.transportSamples =
        mTransportSamples.value_or(std::min(options.transportSamples, options.mostTransportSamples()));
    if (mVisibility) {
        for (const VisibilityMethod method : {VisibilityMethod::Raster, VisibilityMethod::Traced})
            if (*mVisibility == visibilityMethodName(method)) options.visibilityMethod = method;
    }
    if (mRefine) options.refinement = refinementOf(*mRefine);
    if (mOccluder) options.occluderTriangles = occluderFrom(*mOccluder);
    options.validate();
}

Asset bakeWithProgress(const vk::Device& device, Scene scene, const BakeOptions& options, bool quiet,
                       BakeTimes& times) {
    BakeReport report(quiet ? ReportStyle::Quiet : ReportStyle::Text, false);
    return bake(device, std::move(scene), options, report, &times);
}

nlohmann::json describeTimes(const BakeTimes& times, uint64_t vertices) {
    vk::PassTimes stages = times.device;
    vk::addTime(stages, "factorization", times.factorization);
    vk::addTime(stages, "occluder", times.occluder);
    if (times.bounces > 0) vk::addTime(stages, "bounces", times.bounces);
    if (times.previews > 0) vk::addTime(stages, "previews", times.previews);
    vk::addTime(stages, "host and submission", std::max(0.0, times.total - vk::secondsOf(stages)));
    nlohmann::ordered_json list;
    for (const auto& [name, seconds] : stages)
        list[name] = {{"ms_per_vertex", 1e3 * seconds / double(vertices)}, {"share", seconds / times.total}};
    return {{"ms_per_vertex", 1e3 * times.total / double(vertices)},
            {"seconds", times.total},
            {"vertices", vertices},
            {"batch", times.batch},
            {"stages", list}};
}

} // namespace relume
