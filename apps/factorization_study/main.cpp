// Compares the ways to factor a BRDF: docs/factorization.md is made of what this prints and draws.
#include "apps/factorization_study/report.h"
#include "apps/factorization_study/set_price.h"
#include "apps/relume/run_program.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/import/environment_file.h"

#include <CLI/CLI.hpp>
#include <cctype>
#include <chrono>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

using namespace relume;

namespace {

constexpr int kLightSize = 64; // a side of the light cube

using Material = std::pair<std::string, std::string>; // its name here, and as of relume bake

const std::vector<Material>& usualMaterials() {
    static const std::vector<Material> kMaterials = {
        {"Ashikhmin-Shirley (10, 100)", "ashikhmin-shirley"},
        {"clay", "clay"},
        {"skin", "skin"},
        {"red-plastic", "red-plastic"},
        {"brown-plastic", "brown-plastic"},
        {"Cook-Torrance 0.3", R"({"model": "cook-torrance", "diffuse": 0, "f0": 0.5, "roughness": 0.3})"},
        {"Cook-Torrance 0.15",
         R"({"model": "cook-torrance", "diffuse": 0.2, "f0": 0.05, "roughness": 0.15})"},
        {"gold", "gold"},
        {"brushed-steel", "brushed-steel"},
        {"satin", "satin"},
        {"porcelain", "porcelain"},
        {"pearl", "pearl"},
    };
    return kMaterials;
}

// Members of the sets that are priced: unlike each other, each pair, each four and all eight.
const std::vector<Material>& usualSetMembers() {
    static const std::vector<Material> kMembers = {
        {"clay", "clay"},
        {"gold", "gold"},
        {"red-plastic", "red-plastic"},
        {"Ashikhmin-Shirley (10, 100)", "ashikhmin-shirley"},
        {"skin", "skin"},
        {"brushed-steel", "brushed-steel"},
        {"porcelain", "porcelain"},
        {"car-paint-blue", "car-paint-blue"},
    };
    return kMembers;
}

struct Arguments {
    std::vector<std::string> materials, environments;
    bool onlyGiven = false, pricesSets = false;
    std::filesystem::path output = ".";
    StudyOptions options{.sizes = {16, 32, 48, 64}};
};

// From "NAME=FILE", or "FILE", named after itself.
void addLight(const std::string& text, StudyOptions& options) {
    const size_t equals = text.find('=');
    const std::filesystem::path file = equals == std::string::npos ? text : text.substr(equals + 1);
    options.lightNames.push_back(equals == std::string::npos ? file.stem().string() : text.substr(0, equals));
    options.lights.push_back(sampleEnvironment(prepareForSampling(readEnvironment(file)), kLightSize, 0));
}

// Lower-case letters and digits, the rest as underscores.
std::string fileNameOf(const std::string& name) {
    std::string result;
    for (const char letter : name)
        result += std::isalnum(static_cast<unsigned char>(letter)) ? char(std::tolower(letter)) : '_';
    return result;
}

void run(Arguments& arguments) {
    StudyOptions& options = arguments.options;
    for (const std::string& environment : arguments.environments) addLight(environment, options);
    std::vector<Material> materials;
    if (!arguments.onlyGiven) materials = arguments.pricesSets ? usualSetMembers() : usualMaterials();
    for (const std::string& text : arguments.materials) materials.push_back({text, text});
    if (arguments.pricesSets) {
        fmt::print("{}", setPriceOf(materials, options));
        return;
    }
    expectWritable(arguments.output / "factorization.csv");

    std::vector<MaterialStudy> studies;
    for (const auto& [name, text] : materials) {
        const auto start = std::chrono::steady_clock::now();
        studies.push_back(studyMaterial(name, *makeBrdf(text), options));
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
        spdlog::info("{} of {}: {}, {:.1f} s", studies.size(), materials.size(), name, elapsed.count());
    }
    const auto write = [&](const std::string& name, const std::string& text) {
        writeFileAtomically(arguments.output / name, text);
    };
    write("factorization.csv", csvOf(studies, options));
    write("factorization_rms.svg", rmsPlot(studies, options));
    for (size_t light = 0; light < options.lights.size(); light++)
        write("factorization_" + fileNameOf(options.lightNames[light]) + ".svg",
              radiancePlot(studies, options, light));
    fmt::print("{}", summaryOf(studies, options));
}

} // namespace

int main(int argc, char** argv) {
    logToStderr("study");
    CLI::App program{
        "Compares the ways to factor a BRDF: writes factorization.csv and figures, prints tables in "
        "Markdown.",
        "relume_factorization_study"};
    Arguments arguments;
    program.add_option("MATERIAL", arguments.materials, "Further materials, as of relume bake");
    program.add_flag("--only", arguments.onlyGiven, "Only these, not the usual ones");
    program.add_flag("--sets", arguments.pricesSets,
                     "Price sets instead: print the errors of each material alone and in sets of 2, 4, 8 …");
    program.add_option("-e,--environment", arguments.environments, "Light (.exr, .hdr), repeatable")
        ->type_name("[NAME=]FILE")
        ->allow_extra_args(false)
        ->required();
    program.add_option("-o,--output", arguments.output, "Folder to write to")->type_name("FOLDER");
    program.add_option("--sizes", arguments.options.sizes, "Sides of maps")
        ->type_name("S,S,…")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::Range(kMinMapSize, kMaxMapSize))
        ->capture_default_str();
    program.add_option("--orientations", arguments.options.orientations, "Orientations of the light")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    return runProgram(program, argc, argv, [&] {
        if (arguments.onlyGiven && arguments.materials.empty()) throw UsageError("--only: give a MATERIAL");
        run(arguments);
    });
}
