// Maps between the hemisphere and the unit square, in which light and view maps are stored.
// GLSL twin: shaders/lib/disk_map.glsl.
#pragma once

#include "engine/math/vector.h"

#include <optional>
#include <string_view>

namespace relume {

// Values are stored in files and passed to shaders: never renumber.
enum class DiskMapping : uint32_t {
    Orthographic = 0,   // (x, y) = ((d·s + 1) / 2, (d·t + 1) / 2)
    EqualAreaPolar = 1, // (x, y) = (atan2(d·t, d·s) / 2π + 1/2, sqrt(1 - d·n)): older files only
    EqualArea = 2,      // (x, y) = ((d·s, d·t) / sqrt(1 + d·n) + 1) / 2: Lambert's azimuthal projection
    Polar = 3, // (x, y) = (atan2(d·t, d·s) / 2π + 1/2, sqrt(1 - (d·n)²)): section 3.2 of the paper
};

// Returns whether x is an azimuth, so that a map's left and right borders meet.
constexpr bool isPolar(DiskMapping mapping) {
    return mapping == DiskMapping::Polar || mapping == DiskMapping::EqualAreaPolar;
}

// Returns the map coordinates, in [0, 1]², of a unit direction in its local frame with z ≥ 0.
vec2 diskMapCoordinates(DiskMapping mapping, vec3 local);

// Returns the unit direction at map coordinates, or nothing outside the disk.
std::optional<vec3> diskMapDirection(DiskMapping mapping, vec2 coordinates);

// Returns the solid angle per unit of map area, in steradians, at coordinates inside the map's domain.
float diskMapSolidAngle(DiskMapping mapping, vec2 coordinates);

// Returns a direction with z of at least kGrazingCosine. A direction at or below the horizon, as interpolated
// normals give at silhouettes, is lifted to just above it and normalized. Every view lookup uses it.
constexpr float kGrazingCosine = 1e-3f;
vec3 liftAboveHorizon(vec3 local);

// The names in files and on the command line are "orthographic", "polar-sine" (Polar), "equal-area", and
// "polar" (EqualAreaPolar), which new bakes do not accept.
std::string_view diskMappingName(DiskMapping mapping);
std::optional<DiskMapping> diskMappingFromName(std::string_view name);

} // namespace relume
