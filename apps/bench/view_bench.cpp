#include "apps/bench/view_bench.h"

#include "apps/bench/timing.h"
#include "engine/base/progress.h"
#include "engine/math/vector.h"
#include "engine/render/light_pass.h"
#include "engine/render/relighter.h"
#include "engine/render/view_pass.h"

#include <algorithm>

namespace relume {

namespace {

template <typename Work>
void submit(vk::Commands& commands, const Work& work) {
    commands.begin();
    work();
    commands.submitAndWait();
}

// A bake on the device, with a light recorded once.
struct Stage {
    Stage(const vk::Device& device, const Asset& source, const Light& sources, const ViewRounds& rounds,
          int samples)
        : asset(source), light(device, source.faceSize),
          relighter(device, source, {.residual = rounds.residual}),
          view(device, source, {.width = rounds.width, .height = rounds.height, .samples = samples}) {
        light.setLight(sources);
        relighter.setMode(RelightMode::Full); // full, since rotation may change nothing
        vk::Commands commands(device, "first light");
        submit(commands, [&] {
            light.record(commands, glm::radians(rounds.rotationDegrees), rounds.selection);
            relighter.record(commands, light);
        });
    }
    const Asset& asset;
    LightPass light;
    Relighter relighter;
    ViewPass view;
};

// Returns the wall-clock milliseconds of one submission of `work`; adds those of its passes to `passes`.
template <typename Work>
double submission(vk::Commands& commands, std::map<std::string, std::vector<double>>& passes,
                  const Work& work) {
    commands.clearTimes();
    const double ms = milliseconds([&] { submit(commands, work); });
    for (const auto& [name, seconds] : commands.times()) passes[name].push_back(1e3 * seconds);
    return ms;
}

double coveredPixels(const Image& image) {
    return double(std::ranges::count_if(image.pixels, [](const vec4& pixel) { return pixel.w > 0; }));
}

} // namespace

std::vector<ViewSeries> benchView(const vk::Device& device, const std::vector<Asset>& assets,
                                  const Light& light, const ViewRounds& rounds, bool quiet) {
    std::vector<std::unique_ptr<Stage>> stages;
    for (const Asset& asset : assets)
        for (int samples : rounds.samples)
            stages.push_back(std::make_unique<Stage>(device, asset, light, rounds, samples));
    vk::Commands commands(device, "bench view");
    std::vector<ViewSeries> series(stages.size());
    Progress progress("drawing", uint64_t(rounds.count) + 1, "rounds", quiet);
    for (int round = 0; round <= rounds.count; round++) {
        const float turn = 2 * kPi * float(round) / float(rounds.count);
        const float rotation = glm::radians(rounds.rotationDegrees + float(round));
        for (size_t i = 0; i < stages.size(); i++) {
            Stage& stage = *stages[i];
            ViewSeries& own = series[i];
            if (round <= 1) own = {}; // discard the first round, which warmed up
            const Camera camera = rounds.camera(stage.asset, turn);
            const Camera next = rounds.camera(stage.asset, turn + glm::radians(1.0f));
            submit(commands, [&] { stage.view.record(commands, camera, stage.relighter); });
            own.viewMs.push_back(submission(commands, own.viewPasses,
                                            [&] { stage.view.record(commands, next, stage.relighter); }));
            own.lightMs.push_back(submission(commands, own.lightPasses, [&] {
                stage.light.record(commands, rotation, rounds.selection);
                stage.relighter.record(commands, stage.light);
                stage.view.record(commands, next, stage.relighter);
            }));
            own.coveredPixels.push_back(coveredPixels(stage.view.read()));
            own.lightCoefficients.push_back(double(stage.light.readStats().kept));
        }
        progress.update(uint64_t(round) + 1);
    }
    return series;
}

} // namespace relume
