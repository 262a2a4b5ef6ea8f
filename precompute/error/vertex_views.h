// What of each term is seen of a vertex.
#pragma once

#include "engine/render/appearance.h"

namespace relume {

// Per term of the bound set: view maps of the bound layers towards the eye, times layer weights, summed.
std::vector<vec3> vertexViews(const AssetPart& part, const PartAppearance& appearance, uint32_t vertex,
                              vec3 eye);

// The same at any point: `outgoing` is the view direction in its frame, above the horizon, `weights` are
// those of `layers` there.
std::vector<vec3> pointViews(const FactoredBrdf& brdf, std::span<const BoundLayer> layers,
                             std::span<const vec3> weights, vec3 outgoing);

} // namespace relume
