// View changes and whole frames, of several bakes in alternation.
#pragma once

#include "engine/light/light.h"
#include "engine/light/light_selection.h"
#include "engine/scene/camera.h"
#include "engine/transport/asset.h"
#include "engine/vk/commands.h"

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace relume {

struct ViewRounds {
    int count = 9;             // after one that warms up
    float rotationDegrees = 0; // of the light, at first; each further round turns it by a degree
    LightSelection selection;
    int width = 1280, height = 720;
    bool residual = true;                                   // what K terms leave of BRDFs is added
    std::function<Camera(const Asset&, float turn)> camera; // turned by radians
};

// Of one bake; milliseconds, one value a round.
struct ViewSeries {
    std::vector<double> viewMs;  // to record, submit and wait for a view change
    std::vector<double> frameMs; // the same of light, relighting in full and view in one submission
    // Device time of the passes of either, by name; empty where the device has no timestamps.
    std::map<std::string, std::vector<double>> viewPasses, framePasses;
    std::vector<double> coveredPixels;
    std::vector<double> lightCoefficients;
};

// Every round turns the camera by 360 degrees over the number of rounds, and by one more between frame and
// view.
std::vector<ViewSeries> benchView(const vk::Device& device, const std::vector<Asset>& assets,
                                  const Light& light, const ViewRounds& rounds, bool quiet);

} // namespace relume
