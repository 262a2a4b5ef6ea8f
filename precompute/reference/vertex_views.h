// View factors of each term at a vertex or point.
#pragma once

#include "engine/render/appearance.h"

namespace relume {

// Returns, per term of the bound set, the view maps of the bound layers towards the eye, times layer weights,
// summed.
std::vector<vec3> vertexViews(const AssetPart& part, const PartAppearance& appearance, uint32_t vertex,
                              vec3 eye);

// Returns the same at any point. `outgoing` is the view direction in its local frame, above the horizon;
// `weights` are those of `layers` there.
std::vector<vec3> pointViews(const FactoredBrdf& brdf, std::span<const BoundLayer> layers,
                             std::span<const vec3> weights, vec3 outgoing);

} // namespace relume
