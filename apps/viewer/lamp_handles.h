// Lamps as draggable handles on a sphere around the object.
#pragma once

#include "apps/viewer/scene_state.h"
#include "apps/viewer/window.h"

namespace relume {

class LampHandles {
  public:
    // Handles one input; `camera` is the view of the window of this size. Returns true if the input was for a
    // handle.
    bool take(const InputEvent& event, LightState& light, const Camera& camera, const Bounds& model,
              ivec2 size);
    bool isDragging() const { return mHeld.has_value(); }

    // Draws the handles behind all panels, between Ui::begin() and end().
    void draw(const LightState& light, const Camera& camera, const Bounds& model, ivec2 size) const;

  private:
    void drag(LampChoice& lamp, float rotation, const Camera& camera, const Bounds& model, ivec2 size);

    std::optional<size_t> mHeld; // the lamp being dragged
    bool mIsBehind = false;      // on the far side of the sphere
    bool mIsOff = false;         // the cursor is outside the sphere
    vec2 mCursor{0};
};

} // namespace relume
