// Draws light maps as a picture, for inspection.
#pragma once

#include "engine/image/image.h"
#include "engine/scene/factored_brdf.h"

namespace relume {

// Returns the first eight light maps, four per row, with texels of at least 4 × 4 pixels: s to the right, t
// upwards (polar maps: azimuth to the right, zenith below). Each map is scaled by its largest magnitude;
// texels whose channels sum to a negative value show its magnitude in magenta. Display values; dark gray
// outside the maps' domain.
Image drawMapSheet(const FactoredBrdf& brdf);

} // namespace relume
