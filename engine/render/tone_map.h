// From linear radiance to display values. CPU only: a still image's last step.
#pragma once

#include "engine/image/image.h"

#include <optional>
#include <string_view>

namespace relume {

enum class ToneCurve { None, Aces, Agx };

// Scales by 2^exposure, applies the curve, encodes as sRGB and clamps to [0, 1].
Image toneMap(const Image& linear, ToneCurve curve, float exposureStops);

std::optional<ToneCurve> toneCurveFromName(std::string_view name); // "none", "aces", "agx"

} // namespace relume
