// Times relighting in every layout on device and CPU, with the same transport and light, in alternation.
#pragma once

#include "engine/render/light_pass.h"
#include "engine/transport/asset.h"

#include <map>
#include <string>
#include <vector>

namespace relume {

// One asset's transport in several layouts.
struct RelightBenchInput {
    const Asset* source = nullptr;                       // in rows, longer than those that are timed
    std::vector<std::pair<std::string, Asset>> variants; // by name; one is called "rows"
};

// Milliseconds, one value per round.
struct LayoutSeries {
    std::vector<double> deviceMs; // to record, submit and wait for relighting alone
    std::vector<double> cpuMs;
    std::vector<double> bytesTouched; // least number of bytes of transport read, plus bytes of tuples
    std::vector<double> errors; // of tuples, relative L2 to the source's under the light without selection
    // With a small lamp beside the light, after it moved by a degree.
    std::vector<double> lampMs;                   // full relighting
    std::vector<double> incrementalMs;            // incremental relighting
    std::map<int, std::vector<double>> msByCount; // full relighting by number of largest light entries kept
};

struct RelightSeries {
    std::map<std::string, LayoutSeries> layouts;
    std::vector<double> csrMs, lightMs;
    std::vector<double> lightCoefficients;
    std::vector<double> lampCoefficients, lampChanges; // with the lamp: entries kept, and changed by it
};

struct RelightRounds {
    int count = 9;             // after a warm-up round
    float rotationDegrees = 0; // of the first round; the light is rotated by a further degree in each
    LightSelection selection;
    std::vector<int> counts; // additional numbers of light entries to relight from
};

// The lamp has a radius of 3 degrees and alone would light white to radiance 1.
RelightSeries benchRelight(const vk::Device& device, const RelightBenchInput& input, const Light& light,
                           const RelightRounds& rounds, bool quiet);

} // namespace relume
