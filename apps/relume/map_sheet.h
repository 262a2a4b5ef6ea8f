// Light maps as a picture, for people to look at.
#pragma once

#include "engine/image/image.h"
#include "engine/scene/factored_brdf.h"

namespace relume {

// The first eight light maps, four to a row, texels as squares of 4 pixels or more: s to the right, t upwards
// (polar: the azimuth to the right, the zenith below). Each is scaled by its own largest magnitude; where the
// sum of the channels is negative, its magnitude is shown in magenta. Display values; dark gray outside the
// maps' domain.
Image drawMapSheet(const FactoredBrdf& brdf);

} // namespace relume
