// The approximations between a drawn image and the truth, in the order in which they are made exact.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace relume {

enum class ErrorSource {
    Drawing,         // of the device: unshadowed light looked up in lit spheres, not summed; rounding
    LightSelection,  // dropped light entries, and 16-bit quantization of the kept ones
    Storage,         // 11/11/10 bits of transport; for bases, all loss against rows
    Truncation,      // keeping only N wavelet coefficients per row
    Interpolation,   // interpolating the tuples of vertices
    Terms,           // K products instead of the whole tabulated BRDF
    MapResolution,   // S × S texels of the table instead of the BRDF itself
    Evaluation,      // evaluating BRDF and cosine once (or 4 or 16 times) per lighting texel
    LightResolution, // F × F texels per face of the light instead of its own resolution
    Occluder,        // shadows of the baked occluder, with the visibility offset it needs
    Visibility,      // V × V rays per face
    Bounces,         // baked bounced light: K terms, low resolution, interpolated
    MoreBounces,     // reflections between surfaces beyond the baked ones
};
constexpr size_t kErrorSources = 13;

// Return a source's title, for tables, and its name, an identifier for files.
std::string_view errorSourceTitle(ErrorSource source);
std::string_view errorSourceName(ErrorSource source);

} // namespace relume
