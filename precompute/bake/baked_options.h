// What an asset says that it was baked with.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/bake/bake_options.h"

namespace relume {

// Every option that decides bytes, but whether visibility is kept, as Provenance::options holds them.
std::string describeOptions(const BakeOptions& options);

// From an asset's provenance, validated. keepVisibility is false. Throws Error for options that are none, or
// not those of the asset's numbers.
BakeOptions optionsOf(const Asset& asset);

// A part's materials as readMaterials() takes them, to be factored anew. Throws Error for descriptions that
// are no JSON objects.
std::string materialsOf(const AssetPart& part);

} // namespace relume
