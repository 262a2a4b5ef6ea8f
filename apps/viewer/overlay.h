// Marks over the view, behind all panels.
#pragma once

#include "apps/viewer/panels.h"

namespace relume {

// Between Ui::begin() and end(): the line between relit image and reference, the vertex that is explained.
void drawOverlay(const SceneState& state, const PanelFacts& facts, const Camera& camera, ivec2 size);

} // namespace relume
