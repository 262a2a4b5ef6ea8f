// What an asset is and how it was made, for `relume info`.
#pragma once

#include "engine/transport/asset.h"

namespace relume {

// A JSON object, indented, ending in a line break: settings, measured errors, the approximations by name,
// every part's numbers and size in memory, provenance. `fileBytes` is the size of the asset's file, of which
// `visibilityBytes` are kept visibility.
std::string describeAssetJson(const Asset& asset, uint64_t fileBytes, uint64_t visibilityBytes = 0);

} // namespace relume
