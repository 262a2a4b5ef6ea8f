#include "apps/viewer/panel_items.h"

#include <array>
#include <cstring>

namespace relume {

std::optional<std::filesystem::path> saveButton(const char* label, const char* explanation,
                                                const std::string& proposed) {
    static std::array<char, 4096> name; // of the one open prompt
    if (ImGui::Button(label)) {
        std::strncpy(name.data(), proposed.c_str(), name.size() - 1);
        ImGui::OpenPopup(label);
    }
    explain(explanation);
    std::optional<std::filesystem::path> file;
    if (!ImGui::BeginPopup(label)) return file;
    text("Save to");
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(24 * line());
    const bool isEntered =
        ImGui::InputText("##name", name.data(), name.size(), ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    if ((ImGui::Button("Save") || isEntered) && name[0] != '\0') {
        file = name.data();
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
    return file;
}

} // namespace relume
