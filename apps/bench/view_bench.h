// Times changes of view and of light for several bakes in alternation.
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

// The rounds of benchView(), and how views are drawn.
struct ViewRounds {
    int count = 9;             // after a warm-up round
    float rotationDegrees = 0; // of the light in the first round; a degree more in each further one
    LightSelection selection;
    int width = 1280, height = 720;
    bool residual = true;           // draw with the residual
    std::vector<int> samples = {1}; // per pixel: each bake is drawn with each of these
    std::function<Camera(const Asset&, float turn)> camera; // rotated by `turn` radians
};

// The times of one bake at one sample count in milliseconds, one value per round.
struct ViewSeries {
    std::vector<double> viewMs;  // to record, submit and wait for a view with a changed camera
    std::vector<double> lightMs; // the same for light, full relighting and view, under the same camera
    // Device times of the passes of either, by name; empty if the device has no timestamps.
    std::map<std::string, std::vector<double>> viewPasses, lightPasses;
    std::vector<double> coveredPixels;
    std::vector<double> lightCoefficients;
};

// Returns a series for each bake and sample count. Every round rotates the camera by 360 degrees over the
// number of rounds; timed are one more degree of the camera, then one of the light.
std::vector<ViewSeries> benchView(const vk::Device& device, const std::vector<Asset>& assets,
                                  const Light& light, const ViewRounds& rounds, bool quiet);

} // namespace relume
