#include "apps/relume/commands.h"
#include "apps/relume/options.h"
#include "engine/base/error.h"
#include "engine/import/image_file.h"
#include "engine/render/compare.h"

#include <cmath>
#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace relume {

void addCompareCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand("compare", "Measure how an image differs from a reference");
    struct CompareArguments {
        std::string image, reference;
        bool json = false;
        double threshold = std::numeric_limits<double>::infinity();
    };
    const auto arguments = std::make_shared<CompareArguments>();
    command->add_option("IMAGE", arguments->image, "Linear image (.exr, .hdr)")->required();
    command->add_option("REFERENCE", arguments->reference, "What it is held against (.exr, .hdr)")
        ->required();
    command->add_flag("--json", arguments->json, "Print JSON");
    command->add_option("--threshold", arguments->threshold, "Exit with 3 if the relative RMSE is above this")
        ->type_name("RMSE")
        ->check(between(0, 1e30f));
    command->callback([arguments] {
        const ImageDifference difference =
            compareImages(readImage(arguments->image).image, readImage(arguments->reference).image);
        if (arguments->json) {
            // JSON has no infinity, the PSNR of equal images.
            const auto number = [](double value) {
                return std::isfinite(value) ? nlohmann::json(value) : nullptr;
            };
            const nlohmann::json json = {{"relative_rmse", difference.relativeRmse},
                                         {"psnr", number(difference.psnr)},
                                         {"max_difference", difference.maxDifference},
                                         {"flip", difference.flip}};
            fmt::print("{}\n", json.dump(2));
        } else {
            fmt::print("relative RMSE       {:.5f}\n", difference.relativeRmse);
            fmt::print("PSNR                {:.2f} dB\n", difference.psnr);
            fmt::print("largest difference  {:.5f}\n", difference.maxDifference);
            fmt::print("FLIP                {:.5f}\n", difference.flip);
        }
        if (difference.relativeRmse > arguments->threshold) {
            spdlog::error("the relative RMSE {:.5f} is above the threshold {}", difference.relativeRmse,
                          arguments->threshold);
            throw CLI::RuntimeError(kExitOverThreshold);
        }
    });
}

} // namespace relume
