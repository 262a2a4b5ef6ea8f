#include "apps/relume/bake_job.h"
#include "apps/relume/commands.h"
#include "apps/relume/factorization_arguments.h"
#include "apps/relume/scene_arguments.h"
#include "engine/base/error.h"
#include "precompute/bake/baked_options.h"
#include "precompute/brdf/material_json.h"
#include "precompute/brdf/material_list.h"

#include <algorithm>
#include <fmt/ranges.h>

namespace relume {

namespace {

struct RebakeArguments {
    std::string input;
    std::vector<std::string> materials;
    bool separate = false;
    FactorizationArguments factorization;
    LayoutArguments layout;
    std::optional<int> coefficients, mapSize, faceSize, transportSamples, bounces;
    BakeJob job;
};

constexpr const char* kGround = "ground";

// Returns the length of PART if `text` is PART=MATERIAL, with the longest part's name that fits; else npos.
size_t partPrefix(const std::string& text, const Asset& asset) {
    size_t longest = std::string::npos;
    if (looksLikeJson(text)) return longest;
    for (const AssetPart& part : asset.parts)
        if (text.starts_with(part.name + "=") && (longest == std::string::npos || part.name.size() > longest))
            longest = part.name.size();
    std::error_code failure;
    const size_t equals = text.find('=');
    if (longest == std::string::npos && equals != std::string::npos &&
        !std::filesystem::exists(text, failure)) {
        std::vector<std::string> names;
        for (const AssetPart& part : asset.parts) names.push_back(part.name);
        throw UsageError(fmt::format("--material {}: there is no part \"{}\"; the bake has {}", text,
                                     text.substr(0, equals), fmt::join(names, ", ")));
    }
    return longest;
}

// Returns the materials per part, as rebakeToFile() takes them: those that name the part; else, except for a
// ground, those that name none.
std::vector<std::string> materialsFor(const Asset& asset, const RebakeArguments& arguments) {
    std::vector<std::vector<std::string>> own(asset.parts.size());
    std::vector<std::string> others;
    for (const std::string& text : arguments.materials) {
        const size_t prefix = partPrefix(text, asset);
        if (prefix == std::string::npos) {
            others.push_back(text);
            continue;
        }
        for (size_t number = 0; number < own.size(); number++)
            if (asset.parts[number].name == text.substr(0, prefix))
                own[number].push_back(text.substr(prefix + 1));
    }
    std::vector<std::string> joined;
    size_t most = 0;
    bool isUsed = others.empty();
    for (size_t number = 0; number < own.size(); number++) {
        const bool takesOthers = own[number].empty() && asset.parts[number].name != kGround;
        const std::vector<std::string>& chosen = takesOthers ? others : own[number];
        isUsed |= takesOthers;
        most = std::max(most, chosen.size());
        joined.push_back(chosen.empty() ? "" : joinMaterials(chosen, arguments.separate));
        if (!chosen.empty()) readMaterials(joined.back()); // reports errors early
    }
    if (!isUsed)
        throw UsageError(fmt::format("--material {}: no part is left for it; for the ground say -m {}={}",
                                     others.front(), kGround, others.front()));
    if (arguments.separate && most < 2) throw UsageError("--separate: needs several --material for a part");
    return joined;
}

BakeOptions optionsFor(const Asset& asset, RebakeArguments& arguments) {
    BakeOptions options = optionsOf(asset);
    arguments.factorization.resolve(options.factorization, options.mapping);
    options.factorization = arguments.factorization.options;
    options.mapping = arguments.factorization.mapping;
    options.layout = arguments.layout.resolve(options.layout);
    options.coefficients = arguments.coefficients.value_or(options.coefficients);
    options.mapSize = arguments.mapSize.value_or(options.mapSize);
    options.faceSize = arguments.faceSize.value_or(options.faceSize);
    options.transportSamples = arguments.transportSamples.value_or(options.transportSamples);
    options.bounces = arguments.bounces.value_or(options.bounces);
    options.areBouncesAuto = !arguments.bounces;
    options.keepVisibility = arguments.job.keepVisibility;
    options.validate();
    return options;
}

void run(RebakeArguments& arguments) {
    BakeJob& job = arguments.job;
    job.prepare();
    CommandFiles files;
    KeptVisibility kept(arguments.input);
    if (kept.key().empty())
        throw Error(fmt::format("{}: keeps no visibility; bake it again with `relume bake --keep-visibility`",
                                arguments.input));
    Asset skeleton = kept.skeleton();
    const std::vector<std::string> materials = materialsFor(skeleton, arguments);
    BakeOptions options;
    try {
        options = optionsFor(skeleton, arguments);
    } catch (const UsageError&) {
        throw;
    } catch (const Error& wrong) {
        throw Error(fmt::format("{}: {}", arguments.input, wrong.what()));
    }
    job.addOutputs(files, arguments.input);
    files.check();
    const std::unique_ptr<vk::Device> device = job.device.open();
    for (size_t number = 0; number < materials.size(); number++)
        logPart(skeleton.parts[number].name, skeleton.parts[number].mesh,
                materials[number].empty() ? "its own materials" : materials[number]);
    job.run(*device, [&](BakeObserver& observer) {
        return rebakeToFile(*device, kept, std::move(skeleton), materials, options, job.output, job.limits,
                            observer);
    });
}

} // namespace

void addRebakeCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("rebake", "Bake other materials from the visibility that a bake kept");
    const auto arguments = std::make_shared<RebakeArguments>();
    command->add_option("FILE", arguments->input, "Bake made with --keep-visibility (.relume)")->required();
    command
        ->add_option(
            "-m,--material", arguments->materials,
            "What a part is made of from now on: a preset, model, file, or JSON object; without PART= "
            "for all parts that no other names, but for the ground; several, or a {\"set\": […]}, "
            "share one bake")
        ->type_name("[PART=]MATERIAL")
        ->allow_extra_args(false) // one each, since FILE may follow
        ->default_str("the bake's own");
    command->add_flag("--separate", arguments->separate,
                      "Bake several materials each on its own: larger, more exact, swapped but not blended");
    arguments->factorization.add(*command, std::nullopt);
    arguments->layout.add(*command, false);
    command
        ->add_option("-N,--coefficients", arguments->coefficients,
                     "Wavelet coefficients found per vertex and term, in bases four times as many where a "
                     "material has one term")
        ->type_name("N");
    command->add_option("--map-size", arguments->mapSize, "Side of a light or view map")->type_name("S");
    command->add_option("--face-size", arguments->faceSize, "Side of a face of the lighting cube: 32 or 64")
        ->type_name("F");
    command
        ->add_option("--transport-samples", arguments->transportSamples,
                     "BRDF evaluations per lighting texel: 1, 4 or 16")
        ->type_name("COUNT");
    addBounces(*command, arguments->bounces, "the bake's own");
    arguments->job.add(*command);
    command->footer(
        "Meshes, textures and every option that is not given are FILE's own. The new file is, byte for "
        "byte,\n"
        "what `relume bake` makes of the same meshes with the new materials and options. It can be stopped\n"
        "and goes on as `relume bake` does. `--layout rows` leaves N as it is, 384 unless FILE was baked "
        "with\n"
        "another: name it too, -N 96 say.\n"
        "relume bake bunny.obj --ground --keep-visibility -o bunny.relume\n"
        "relume rebake bunny.relume -m gold -m ground=clay -o gold.relume");
    command->callback([arguments] { run(*arguments); });
}

} // namespace relume
