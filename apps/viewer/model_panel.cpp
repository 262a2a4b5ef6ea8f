#include "apps/viewer/outputs.h"
#include "apps/viewer/panel_items.h"
#include "apps/viewer/panels.h"

#include <algorithm>
#include <fmt/core.h>

namespace relume {

void drawModelPanel(const PanelFacts& facts, PanelRequests& requests) {
    const auto& models = facts.content->models();
    const auto& shown = facts.content->shown();
    for (size_t i = 0; i < models.size(); i++) {
        ImGui::PushID(int(i));
        if (ImGui::RadioButton(models[i]->file.filename().string().c_str(), models[i] == shown))
            requests.shows = i;
        explain(models[i]->file.string().c_str());
        if (models.size() > 1) {
            ImGui::SameLine();
            if (ImGui::SmallButton("Close")) requests.closes = i;
        }
        ImGui::PopID();
    }
    if (models.size() > 1) ImGui::TextDisabled("B: the next one");
    if (shown) {
        uint64_t vertices = 0, triangles = 0, bytes = 0;
        for (const AssetPart& part : shown->asset.parts) {
            vertices += part.mesh.vertexCount();
            triangles += part.mesh.triangleCount();
            for (const MaterialSet& set : part.sets) bytes += bytesOf(set.transport);
        }
        text(fmt::format("{} vertices, {} triangles", vertices, triangles));
        if (shown->isSketch)
            text("not baked yet: without shadows");
        else
            text(fmt::format("transport: {:.1f} MB, {:.0f} bytes a vertex", double(bytes) * 1e-6,
                             double(bytes) / double(std::max<uint64_t>(1, vertices))));
        if (const std::optional<float> share = shown->asset.provenance.bakedShare)
            text(fmt::format("a preview: {:.0f} % is baked", 100 * *share));
    }
    const auto& recent = facts.content->recent();
    if (!recent.empty() && ImGui::BeginCombo("Recent", "open again")) {
        for (const std::filesystem::path& file : recent) {
            ImGui::PushID(file.string().c_str()); // names may repeat
            if (ImGui::Selectable(file.filename().string().c_str())) requests.opens = file;
            explain(file.string().c_str());
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
    if (shown) {
        requests.savesSession =
            saveButton("Save session",
                       "View, light and materials in a file that this program opens and relume render draws; "
                       "Ctrl + S does so at once",
                       outputName(".session.json"));
    }
    ImGui::TextDisabled("Drop files to open them");
}

} // namespace relume
