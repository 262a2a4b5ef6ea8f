#include "apps/relume/commands.h"
#include "precompute/brdf/brdf.h"
#include "precompute/brdf/material_json.h"
#include "precompute/brdf/model_list.h"

#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

void printText() {
    fmt::print("Presets\n");
    for (const MaterialPreset& preset : materialPresets())
        fmt::print("  {:18} {:18} {}\n", preset.name, preset.model, preset.description);
    fmt::print("\nModels\n");
    for (const MaterialModel& model : materialModels()) {
        fmt::print("  {:18} {}\n", model.name, model.description);
        for (const MaterialParameter& parameter : model.parameters)
            fmt::print("    {:16} {}, {}\n", parameter.name, parameter.values,
                       parameter.fallback.empty() ? "required" : "default " + parameter.fallback);
    }
    fmt::print("\nMeasured data\n"
               "  A MERL file (.binary) or Cornell's text (.brdf): its path, or {{\"measured\": PATH, "
               "\"scale\": 1}}\n"
               "\nA material is a preset, a model, JSON ({{\"model\": \"plastic\", \"roughness\": 0.1}}), or "
               "the path\n"
               "of a file of such JSON (.json)\n");
}

} // namespace

void addMaterialsCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("materials", "List the preset materials, the models and their parameters");
    const auto json = std::make_shared<bool>(false);
    command->add_flag("--json", *json, "Print JSON");
    command->callback([json] {
        if (*json)
            fmt::print("{}\n", describeMaterials().dump(2));
        else
            printText();
    });
}

} // namespace relume
