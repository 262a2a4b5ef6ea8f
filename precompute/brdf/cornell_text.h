// Reads the text of a Cornell BRDF file without interpreting it.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace relume {

struct CornellSample {
    std::array<float, 4> angles; // θi, φi, θs, φs in radians
    std::vector<float> values;   // sr⁻¹, one per wavelength; finite, may be negative
};

struct CornellText {
    std::vector<float> wavelengths; // nanometers, ascending
    std::vector<CornellSample> samples;
};

// Throws Error naming `name` and the line at fault.
CornellText readCornellText(std::string_view text, const std::string& name);

} // namespace relume
