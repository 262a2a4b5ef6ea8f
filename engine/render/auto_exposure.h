// The exposure that an image asks for itself.
#pragma once

#include "engine/image/image.h"

namespace relume {

// Stops, to a hundredth, that bring the log-average luminance of what is covered to 0.3: the key of
// Reinhard, Stark, Shirley, Ferwerda, "Photographic Tone Reproduction for Digital Images", 2002. Pixels count
// by their alpha, with which radiance is premultiplied. The brightest 2 % count as the darkest of them, and
// what is darker than a thousandth of that does not count: highlights and black do not decide. 0 if nothing
// is left. From -20 to 20.
float autoExposure(const Image& image);

} // namespace relume
