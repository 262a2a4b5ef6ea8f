// What all panels are written with.
#pragma once

#include <fmt/format.h>
#include <imgui.h>
#include <string>

namespace relume {

// Sizes are in lines of text, so that all of it grows with the font.
inline float line() { return ImGui::GetFontSize(); }

// A tooltip of the item before.
inline void explain(const char* text) {
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

inline void text(const std::string& words) { ImGui::TextUnformatted(words.c_str()); }

// Buttons of which one is pressed, side by side. True: another one is.
template <typename Choice, size_t kCount>
bool chooseOne(const char* const (&names)[kCount], Choice& chosen) {
    const Choice before = chosen;
    for (size_t i = 0; i < kCount; i++) {
        if (i > 0) ImGui::SameLine();
        if (ImGui::RadioButton(names[i], chosen == Choice(i))) chosen = Choice(i);
    }
    return chosen != before;
}

} // namespace relume
