// Automatic exposure of an image.
#pragma once

#include "engine/image/image.h"

namespace relume {

// Returns the exposure in stops, rounded to a hundredth and between -20 and 20, that brings the log-average
// luminance of covered pixels to 0.3: the key of Reinhard, Stark, Shirley, Ferwerda, "Photographic Tone
// Reproduction for Digital Images", 2002. Pixels are weighted by alpha, with which radiance is premultiplied.
// Highlights and black do not decide: the brightest 2 % count as the darkest of them, and pixels darker than
// a thousandth of that are ignored. Returns 0 if nothing is left.
float autoExposure(const Image& image);

} // namespace relume
