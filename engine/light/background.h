// The background of an image: distant light as the eye sees it.
#pragma once

#include "engine/image/image.h"
#include "engine/light/light.h"
#include "engine/scene/camera.h"
#include "shaders/shared/background.h"

namespace relume {

// The picture of a light behind the object: its environments at full resolution, the sky, strokes over both,
// and the sun's disc. Lamps and distant lights are not shown: they stand for lights outside the image.
struct Background {
    std::shared_ptr<const Environment> map; // null: black
    float rotation = 0, gain = 1;           // of the map, as in EnvironmentLight
    std::optional<shared::LightSky> sky = std::nullopt;
    std::vector<shared::BackgroundDisc> strokes = {};
    shared::BackgroundDisc sun{}; // black if there is none
    // The sources that `map` was resampled from, if it was, and the deviation of its blur: they tell whether
    // it can be reused.
    std::vector<EnvironmentLight> environments = {};
    Light blurred = {};
    float deviation = 0;

    // Returns the radiance from a unit direction. Discs fade over `edge`, a distance of unit vectors.
    vec3 radiance(vec3 direction, float edge) const;
};

// Makes the background of a light, blurred with a standard deviation of `deviation` radians (0: sharp).
// Reuses the map of `before` if the sources are the same. Several environments, or a blur, are resampled into
// one map, which takes time; a single sharp environment, sky, strokes and sun are not.
Background makeBackground(const Light& light, float deviation = 0, const Background& before = {});

// Returns the push constants that draw a background, turned by `turn` radians as by turned(), at this size.
shared::BackgroundPush makeBackgroundPush(const Background& background, const Camera& camera, float turn,
                                          int width, int height);

// Composites an image, premultiplied by alpha, over the background; alpha is 1 afterwards. CPU twin of
// shaders/background.frag.
void drawBackground(Image& image, const Background& background, const Camera& camera, float turn);

} // namespace relume
