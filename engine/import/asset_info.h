// A description of an asset, for `relume info`.
#pragma once

#include "engine/transport/asset.h"

namespace relume {

// Returns an indented JSON object that ends in a line break: settings, measured errors, the approximations by
// name, every part's numbers and size in memory, provenance. `fileBytes` is the size of the asset's file, of
// which `visibilityBytes` are kept visibility.
std::string describeAssetJson(const Asset& asset, uint64_t fileBytes, uint64_t visibilityBytes = 0);

// Returns the most entries of rows that a bake makes transport from, of all sets: "96", or "384 or 1536".
std::string describeRowEntries(const Asset& asset);

} // namespace relume
