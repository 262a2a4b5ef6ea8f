// Checks of arguments, which are as little trusted as files. Each throws UsageError with the argument's name,
// what was expected and what was found.
#pragma once

#include "engine/base/error.h"
#include "engine/light/light.h"
#include "engine/scene/camera.h"

#include <fmt/core.h>
#include <memory>
#include <utility>

namespace relume::python {

// Coordinates, distances and angles in degrees lie within this, either way, as those of the command line do.
constexpr float kLargestNumber = 1e6f;

// Expects least ≤ value ≤ most; not a number is within nothing.
template <typename T>
void expectWithin(const char* name, T value, T least, T most) {
    if (!(value >= least && value <= most))
        throw UsageError(fmt::format("{}: expected {} to {}, found {}", name, least, most, value));
}

// Expects 1 to 16384 pixels a side, of (width, height).
void expectSize(std::pair<int, int> size);

// Expects an object: None arrives as null.
template <typename T>
const std::shared_ptr<T>& expectGiven(const char* name, const std::shared_ptr<T>& object) {
    if (!object) throw UsageError(fmt::format("{}: expected one, found None", name));
    return object;
}

// Returns the camera if a view can be drawn from it.
Camera checked(const Camera& camera);

// Returns the light if its sources are finite, not negative, not too bright and not too many.
Light checked(Light light);

} // namespace relume::python
