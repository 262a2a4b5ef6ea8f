// The same transport and light, relit from every layout on the device and on the CPU, in alternation.
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
    std::vector<std::pair<std::string, Asset>> variants; // by name; "rows" among them
};

// Milliseconds, one value a round.
struct LayoutSeries {
    std::vector<double> deviceMs; // to record, submit and wait for relighting alone
    std::vector<double> cpuMs;
    std::vector<double> bytesTouched; // of transport that is read at least, and of tuples
    std::vector<double> errors;       // of tuples, relative L2 to the source's under the light as given
    // With a small lamp beside the light, after it moved by a degree.
    std::vector<double> lampMs;                   // in full
    std::vector<double> incrementalMs;            // by what changed
    std::map<int, std::vector<double>> msByCount; // by how many of the light's largest coefficients are kept
};

struct RelightSeries {
    std::map<std::string, LayoutSeries> layouts;
    std::vector<double> csrMs, lightMs;
    std::vector<double> lightCoefficients;
    std::vector<double> lampCoefficients, lampChanges; // with the lamp: kept, and not as before it moved
};

struct RelightRounds {
    int count = 9;             // after one that warms up
    float rotationDegrees = 0; // of the first; each further one turns the light by a degree
    LightSelection selection;
    std::vector<int> counts; // of kept light coefficients, to relight from as well
};

// The lamp is one of 3 degrees that alone would light white to radiance 1.
RelightSeries benchRelight(const vk::Device& device, const RelightBenchInput& input, const Light& light,
                           const RelightRounds& rounds, bool quiet);

} // namespace relume
