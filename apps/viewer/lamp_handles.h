// Lamps as handles on a sphere around the object, to be dragged in the view.
#pragma once

#include "apps/viewer/scene_state.h"
#include "apps/viewer/window.h"

namespace relume {

class LampHandles {
  public:
    // One input; `camera` is what the window of this size shows. True: it was for a handle, nobody else's.
    bool take(const InputEvent& event, LightState& light, const Camera& camera, const Bounds& model,
              ivec2 size);
    bool isDragging() const { return mHeld.has_value(); }

    // Between Ui::begin() and end(), behind all panels.
    void draw(const LightState& light, const Camera& camera, const Bounds& model, ivec2 size) const;

  private:
    void drag(LampChoice& lamp, float rotation, const Camera& camera, const Bounds& model, ivec2 size);

    std::optional<size_t> mHeld; // the lamp in hand
    bool mIsBehind = false;      // it is on the sphere's far side
    bool mIsOff = false;         // the cursor is beside the sphere
    vec2 mCursor{0};
};

} // namespace relume
