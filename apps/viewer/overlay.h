// Draws marks over the view, behind all panels.
#pragma once

#include "apps/viewer/panels.h"

namespace relume {

// Draws the line between relit image and reference, and the vertex being explained. Between Ui::begin() and
// end().
void drawOverlay(const SceneState& state, const PanelFacts& facts, const Camera& camera, ivec2 size);

} // namespace relume
