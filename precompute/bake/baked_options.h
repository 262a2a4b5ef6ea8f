// Conversion between bake options and what an asset records of them.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/bake/bake_options.h"

namespace relume {

// Returns as text, for Provenance::options, every option that determines bytes, except keepVisibility.
std::string describeOptions(const BakeOptions& options);

// Returns the options recorded in an asset, validated; keepVisibility is false. Throws Error if the record is
// invalid or contradicts the asset's sizes.
BakeOptions optionsOf(const Asset& asset);

// Returns a part's materials as text for readMaterials(), so that they can be factored anew. Throws Error if
// a description is not a JSON object.
std::string materialsOf(const AssetPart& part);

} // namespace relume
