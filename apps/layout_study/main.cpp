// Measures what layouts of transport lose for their bytes: docs/layouts.md holds its tables and plots.
#include "apps/layout_study/report.h"
#include "apps/relume/run_program.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/import/environment_file.h"

#include <fmt/format.h>

using namespace relume;

namespace {

struct Arguments {
    std::vector<std::string> bakes, environments;
    std::filesystem::path output = ".";
    StudyOptions options{.rows = {24, 48, 96, 192}, .budgets = {50, 100, 200, 400, 800, 1600}};
};

// From "NAME=FILE", or "FILE", named after itself. Names may have a = of their own.
std::pair<std::string, std::filesystem::path> namedFile(const std::string& text) {
    const size_t equals = text.rfind('=');
    const std::filesystem::path file = equals == std::string::npos ? text : text.substr(equals + 1);
    return {equals == std::string::npos ? file.stem().string() : text.substr(0, equals), file};
}

void run(Arguments& arguments) {
    StudyOptions& options = arguments.options;
    expectWritable(arguments.output / "layouts.csv");
    std::vector<Environment> maps;
    for (const std::string& text : arguments.environments) {
        const auto [name, file] = namedFile(text);
        options.lightNames.push_back(name);
        maps.push_back(prepareForSampling(readEnvironment(file)));
    }
    const vk::Device device;
    References references(options);
    std::vector<BakeStudy> studies;
    for (const std::string& text : arguments.bakes) {
        const auto [name, file] = namedFile(text);
        const Asset asset = readAsset(file);
        for (const AssetPart& part : asset.parts)
            if (layoutOf(part.sets[0].transport) != TransportLayout::Rows)
                throw Error(fmt::format("{}: expected a bake in rows, best of many coefficients, found {}",
                                        file.string(), layoutName(layoutOf(part.sets[0].transport))));
        options.lights.clear();
        for (const Environment& map : maps)
            options.lights.push_back(sampleEnvironment(map, asset.faceSize, 0));
        studies.push_back(studyBake(device, name, asset, references, options));
        fmt::print("{}", summaryOf({studies.back()}, options));
        // After every bake: the next may take long.
        writeFileAtomically(arguments.output / "layouts.csv", csvOf(studies, options));
        writeFileAtomically(arguments.output / "layouts_relit.svg", relitPlot(studies, options));
        writeFileAtomically(arguments.output / "layouts_image.svg", imagePlot(studies, options));
    }
}

} // namespace

int main(int argc, char** argv) {
    logToStderr("study");
    CLI::App program{
        "Measures errors of transport, of relit tuples and of images against ray tracing, over the bytes "
        "of each\nlayout: writes layouts.csv and figures, prints tables in Markdown.",
        "relume_layout_study"};
    Arguments arguments;
    program
        .add_option("BAKE", arguments.bakes,
                    "Bakes in rows of many coefficients (.relume); those of one surface one after the other")
        ->type_name("[NAME=]FILE")
        ->required();
    program.add_option("-e,--environment", arguments.environments, "Light (.exr, .hdr), repeatable")
        ->type_name("[NAME=]FILE")
        ->allow_extra_args(false)
        ->required();
    program.add_option("-o,--output", arguments.output, "Folder to write to")->type_name("FOLDER");
    program.add_option("--rows", arguments.options.rows, "Most coefficients of a row, in rows")
        ->type_name("N,N,…")
        ->delimiter(',')
        ->check(CLI::Range(1, 24576))
        ->capture_default_str();
    program.add_option("--budgets", arguments.options.budgets, "Bytes a vertex of clusters and bases")
        ->type_name("B,B,…")
        ->delimiter(',')
        ->check(CLI::Range(1.0, 1e6))
        ->capture_default_str();
    program.add_option("--width", arguments.options.width, "Of images")
        ->check(CLI::Range(16, 4096))
        ->capture_default_str();
    program.add_option("--height", arguments.options.height, "Of images")
        ->check(CLI::Range(16, 4096))
        ->capture_default_str();
    return runProgram(program, argc, argv, [&] { run(arguments); });
}
