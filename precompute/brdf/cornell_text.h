// The text of a Cornell BRDF file, read but not yet interpreted.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace relume {

struct CornellSample {
    std::array<float, 4> angles; // θi, φi, θs, φs in radians
    std::vector<float> values;   // sr⁻¹, one per wavelength; finite, perhaps negative
};

struct CornellText {
    std::vector<float> wavelengths; // nanometres, rising
    std::vector<CornellSample> samples;
};

// Throws Error naming `name` and the line of what is wrong.
CornellText readCornellText(std::string_view text, const std::string& name);

} // namespace relume
