// Tone mapping of linear radiance to display values. DisplayPass does the same on the device.
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

} // namespace relume
