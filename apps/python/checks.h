// Checks of arguments, which are trusted no more than files. Each throws UsageError with the argument's name,
// what was expected and what was found.
#pragma once

#include "engine/base/error.h"
#include "engine/light/light.h"
#include "engine/scene/camera.h"
#include "engine/transport/asset.h"

#include <fmt/core.h>
#include <memory>
#include <utility>

namespace relume::python {

// The largest magnitude of distances, weights and angles in degrees, as on the command line.
constexpr float kLargestNumber = 1e6f;

// Expects least ≤ value ≤ most, which NaN is not.
template <typename T>
void expectWithin(const char* name, T value, T least, T most) {
    if (!(value >= least && value <= most))
        throw UsageError(fmt::format("{}: expected {} to {}, found {}", name, least, most, value));
}

// Expects 1 to 16384 pixels a side, of (width, height).
void expectSize(std::pair<int, int> size);

// Expects 1, 2, 4 or 8 samples of a pixel.
void expectSamples(int samples);

// Returns the asset, and refuses null, as which None arrives.
const std::shared_ptr<Asset>& expectAsset(const std::shared_ptr<Asset>& asset);

// Returns the asset, and refuses one without transport, which plan() makes.
const std::shared_ptr<Asset>& expectBaked(const std::shared_ptr<Asset>& asset);

// Returns the camera if a view can be drawn from it.
Camera checked(const Camera& camera);

// Returns the light if its sources are finite, not negative, and neither too bright nor too many for the
// device and for sums of squares.
Light checked(Light light);

} // namespace relume::python
