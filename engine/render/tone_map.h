// Exposure and tone mapping of linear radiance to display values. DisplayPass maps tones in the same way on
// the device.
#pragma once

#include "engine/image/image.h"

#include <optional>
#include <string_view>

namespace relume {

enum class ToneCurve {
    None,
    Aces, // per channel: the rational fit of Narkowicz, "ACES Filmic Tone Mapping Curve", 2016
    Agx,  // Sobotka's AgX, base look, by the polynomial of Wrensch, "Minimal AgX Implementation", 2023
};

// Scales by 2^exposureStops, applies the curve, encodes as sRGB (IEC 61966-2-1) and clamps to [0, 1]. Alpha
// is kept. Negative values and NaN become 0.
Image toneMap(const Image& linear, ToneCurve curve, float exposureStops);

std::optional<ToneCurve> toneCurveFromName(std::string_view name); // "none", "aces", "agx"

// Returns the exposure in stops, rounded to a hundredth and between -20 and 20, that brings the log-average
// luminance of covered pixels to 0.3: the key of Reinhard, Stark, Shirley, Ferwerda, "Photographic Tone
// Reproduction for Digital Images", 2002. Pixels are weighted by alpha, with which radiance is premultiplied.
// Highlights and black do not decide: the brightest 2 % count as the darkest of them, and pixels darker than
// a thousandth of that are ignored. Returns 0 if nothing is left.
float autoExposure(const Image& image);

} // namespace relume
