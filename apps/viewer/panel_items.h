// The building blocks of panels.
#pragma once

#include <cmath>
#include <filesystem>
#include <fmt/core.h>
#include <imgui.h>
#include <optional>
#include <string>

namespace relume {

// Returns the height of a line of text, the unit of all sizes, which scale with the font.
inline float line() { return ImGui::GetFontSize(); }

// Adds a tooltip to the preceding item.
inline void explain(const char* text) {
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

inline void text(const std::string& words) { ImGui::TextUnformatted(words.c_str()); }

// Draws a slider that accepts only finite values within its range, also when they are typed. Returns true if
// it changed.
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

// Draws a button that asks for a file name, which is `proposed` at first. Returns the file once the user
// confirms it.
std::optional<std::filesystem::path> saveButton(const char* label, const char* explanation,
                                                const std::string& proposed);

// Draws radio buttons side by side.
template <typename Choice, size_t kCount>
void chooseOne(const char* const (&names)[kCount], Choice& chosen) {
    for (size_t i = 0; i < kCount; i++) {
        if (i > 0) ImGui::SameLine();
        if (ImGui::RadioButton(names[i], chosen == Choice(i))) chosen = Choice(i);
    }
}

} // namespace relume
