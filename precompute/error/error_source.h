// The approximations between a drawn image and the truth, in the order in which they are made exact.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace relume {

enum class ErrorSource {
    Drawing,         // what the device's image is off its recomputation: light without shadows looked up in
                     // lit spheres instead of summed (residual.h), and rounding
    LightSelection,  // coefficients of the light that are dropped, and the 16 bits of those that are kept
    Storage,         // 11/11/10 bits of transport; of bases, all that they lose against rows
    Truncation,      // keeping N wavelet coefficients of a row
    Interpolation,   // tuples of vertices instead of every point's own
    Terms,           // K products instead of all that the tabulated BRDF has
    MapResolution,   // S × S texels of the table instead of the BRDF itself
    Evaluation,      // BRDF and cosine taken once (or 4 or 16 times) a lighting texel
    LightResolution, // F × F texels a face of the light instead of its own resolution
    Occluder,        // shadows of the baked occluder, from the height that it asks for
    Visibility,      // V × V rays a face
    Bounces,         // light of other surfaces as it is baked: of K terms, at a low resolution, interpolated
    MoreBounces,     // reflections between surfaces beyond those that are baked
};
constexpr size_t kErrorSources = 13;

// In a few words, for tables; and as an identifier, for files.
std::string_view errorSourceTitle(ErrorSource source);
std::string_view errorSourceName(ErrorSource source);

} // namespace relume
