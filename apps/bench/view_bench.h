// Changes of view and of light, of several bakes in alternation.
#pragma once

#include "engine/light/light.h"
#include "engine/light/light_selection.h"
#include "engine/render/pixel_samples.h"
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
    std::vector<int> samples = {1};                         // a pixel: each bake is drawn with each of them
    std::function<Camera(const Asset&, float turn)> camera; // turned by radians
};

// The times of one bake at one sample count, in milliseconds: one value a round.
struct ViewSeries {
    std::vector<double> viewMs;  // to record, submit and wait for a view under another camera
    std::vector<double> lightMs; // the same of light, relighting in full and view under the same camera
    // Device time of the passes of either, by name; empty where the device has no timestamps.
    std::map<std::string, std::vector<double>> viewPasses, lightPasses;
    std::vector<double> coveredPixels;
    std::vector<double> lightCoefficients;
};

// Returns a series for each bake and, within it, each sample count. Every round turns the camera by 360
// degrees over the number of rounds; what is timed is a further degree, and then one of the light.
std::vector<ViewSeries> benchView(const vk::Device& device, const std::vector<Asset>& assets,
                                  const Light& light, const ViewRounds& rounds, bool quiet);

} // namespace relume
