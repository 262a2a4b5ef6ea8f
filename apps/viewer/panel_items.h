// What all panels are written with.
#pragma once

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <imgui.h>
#include <optional>
#include <string>

namespace relume {

// Sizes are in lines of text, so that all of it grows with the font.
inline float line() { return ImGui::GetFontSize(); }

// A tooltip of the item before.
inline void explain(const char* text) {
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

inline void text(const std::string& words) { ImGui::TextUnformatted(words.c_str()); }

// A slider that takes no number beyond its ends, and nothing that is none, also where one is typed. True: it
// was moved.
inline bool slider(const char* label, float& value, float low, float high, const char* format,
                   ImGuiSliderFlags flags = 0) {
    float changed = value;
    if (!ImGui::SliderFloat(label, &changed, low, high, format, flags | ImGuiSliderFlags_AlwaysClamp) ||
        !std::isfinite(changed))
        return false;
    value = changed;
    return true;
}
inline bool slider(const char* label, int& value, int low, int high, const char* format,
                   ImGuiSliderFlags flags = 0) {
    return ImGui::SliderInt(label, &value, low, high, format, flags | ImGuiSliderFlags_AlwaysClamp);
}

// A button that asks where to save; returns the file once that is confirmed. `proposed` is the name it begins
// with.
std::optional<std::filesystem::path> saveButton(const char* label, const char* explanation,
                                                const std::string& proposed);

// Buttons of which one is pressed, side by side.
template <typename Choice, size_t kCount>
void chooseOne(const char* const (&names)[kCount], Choice& chosen) {
    for (size_t i = 0; i < kCount; i++) {
        if (i > 0) ImGui::SameLine();
        if (ImGui::RadioButton(names[i], chosen == Choice(i))) chosen = Choice(i);
    }
}

} // namespace relume
