#include "engine/render/ground_fade.h"

#include "engine/math/color.h"
#include "shaders/shared/render.h"

#include <algorithm>

namespace relume {

// Largest ratio of inner to outer radius, since an object may be as large as its ground.
static constexpr float kMostInner = 0.6f;

// Largest height of a flat ground, as a share of its width.
static constexpr float kFlatHeight = 0.02f;

std::optional<size_t> groundOf(const Asset& asset) {
    const auto ground = std::ranges::find(asset.parts, "ground", &AssetPart::name);
    if (ground == asset.parts.end()) return std::nullopt;
    return size_t(ground - asset.parts.begin());
}

std::optional<GroundFade> makeGroundFade(const Asset& asset, GroundStyle style) {
    const std::optional<size_t> ground = groundOf(asset);
    if (style == GroundStyle::Whole || !ground) return std::nullopt;
    const Bounds object = objectBounds(asset), edges = boundsOf(asset.parts[*ground].mesh);
    const vec2 center(object.center().x, object.center().z), reach(object.extent().x, object.extent().z);
    const float outer = std::min(
        {center.x - edges.low.x, edges.high.x - center.x, center.y - edges.low.z, edges.high.z - center.y});
    if (!(outer > 0)) return std::nullopt;
    const bool isFlat = edges.extent().y <= kFlatHeight * std::max(edges.extent().x, edges.extent().z);
    return GroundFade{*ground,
                      center,
                      std::min(0.5f * glm::length(reach), kMostInner * outer),
                      outer,
                      style == GroundStyle::Shadow && isFlat,
                      edges.low.y};
}

float shadowAlpha(vec3 radiance, vec3 unshadowed) {
    const float all = luminance(unshadowed);
    const float shadow = all > 0 ? 1 - std::clamp(luminance(radiance) / all, 0.0f, 1.0f) : 0;
    return std::max(shadow - shared::kLeastShadow, 0.0f) / (1 - shared::kLeastShadow);
}

float groundCoverage(const GroundFade& fade, vec3 position) {
    const float away = glm::distance(vec2(position.x, position.z), fade.center);
    const float share = 1 - glm::smoothstep(fade.inner, fade.outer, away);
    return share * share; // squared for a long tail, so that no rim is visible
}

} // namespace relume
