#include "engine/light/background.h"

#include "engine/base/check.h"
#include "engine/light/cap.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

// Columns that a blurred map has per standard deviation of the blur.
constexpr float kColumnsPerDeviation = 8;
// Columns of a map without an environment, made of sky and strokes alone.
constexpr int kOwnColumns = 2048;
constexpr int kFewestColumns = 32;

const std::shared_ptr<const Environment>& pictureOf(const EnvironmentLight& light) {
    return light.picture ? light.picture : light.map;
}

shared::BackgroundDisc discOf(const Stroke& stroke) {
    const float inner = chord(stroke.angularRadius * (1 - stroke.softness)),
                outer = chord(stroke.angularRadius);
    return {glm::normalize(stroke.direction), inner, outer, stroke.opacity, stroke.radiance};
}

shared::BackgroundDisc discOf(const Lamp& lamp) {
    const float edge = chord(lamp.angularRadius);
    return {glm::normalize(lamp.direction), edge, edge, 1, lamp.radiance};
}

float coverage(const shared::BackgroundDisc& disc, vec3 direction, float edge) {
    const float outer = disc.outer + 0.5f * edge, inner = disc.inner - 0.5f * edge;
    const float share = (outer - glm::distance(direction, disc.center)) / std::max(outer - inner, 1e-9f);
    return disc.amount * std::clamp(share, 0.0f, 1.0f);
}

vec3 turnedBy(vec3 d, float angle) {
    const float cosine = std::cos(angle), sine = std::sin(angle);
    return {cosine * d.x + sine * d.z, d.y, cosine * d.z - sine * d.x};
}

template <typename Work>
void forEachPixel(Environment& map, Work work) {
    for (int y = 0; y < map.height; y++)
        for (int x = 0; x < map.width; x++)
            work(map.radiance[size_t(y) * size_t(map.width) + size_t(x)],
                 map.direction(float(x) + 0.5f, float(y) + 0.5f));
}

Environment makeBlackMap(int width) {
    const int height = std::max(1, width / 2);
    return {width, height, std::vector<vec3>(size_t(width) * size_t(height), vec3(0))};
}

// Returns the sum of the environments as one map, each at its own rotation and gain.
Environment sumOf(const std::vector<EnvironmentLight>& lights, int width) {
    Environment sum = makeBlackMap(width);
    for (const EnvironmentLight& light : lights) {
        const Environment& picture = *pictureOf(light);
        const Environment smaller =
            picture.width > width ? prepareForSampling(picture, width) : Environment{};
        const Environment& map = picture.width > width ? smaller : picture;
        if (light.rotation == 0 && map.width == sum.width && map.height == sum.height)
            for (size_t i = 0; i < sum.radiance.size(); i++) sum.radiance[i] += light.gain * map.radiance[i];
        else
            forEachPixel(sum, [&](vec3& radiance, vec3 d) {
                radiance += light.gain * map.lookup(turnedBy(d, -light.rotation));
            });
    }
    return sum;
}

// Adds the sun's light to the pixels around it, with its full energy even if its disc is smaller than a
// pixel.
void addSun(Environment& map, const Lamp& sun) {
    if (sun.radiance == vec3(0)) return;
    const shared::BackgroundDisc disc = discOf(sun);
    const float pixel = 2 * kPi / float(map.width);
    const auto solidAngle = [&](vec3 d) { return pixel * pixel * std::sqrt(std::max(1 - d.y * d.y, 0.0f)); };
    float covered = 0;
    forEachPixel(map, [&](vec3&, vec3 d) { covered += coverage(disc, d, 2 * pixel) * solidAngle(d); });
    const float scale = covered > 0 ? capSolidAngle(sun.angularRadius) / covered : 0;
    forEachPixel(map, [&](vec3& radiance, vec3 d) {
        radiance += scale * coverage(disc, d, 2 * pixel) * sun.radiance;
    });
}

int widest(const std::vector<EnvironmentLight>& lights) {
    int width = 0;
    for (const EnvironmentLight& light : lights) width = std::max(width, pictureOf(light)->width);
    return width;
}

// Returns the sources that are visible as background.
Light visibleSources(const Light& light) {
    return {.environments = light.environments,
            .sky = light.sky,
            .strokes = light.strokes,
            .lamps = {},
            .distant = {}};
}

Background blurredBackground(const Light& light, float deviation, const Background& before) {
    Background background;
    background.deviation = deviation;
    background.blurred = visibleSources(light);
    const Light &now = background.blurred, &last = before.blurred;
    if (before.map && before.deviation == deviation && last.environments == now.environments &&
        last.sky == now.sky && last.strokes == now.strokes) {
        background.map = before.map;
        return background;
    }
    const int width = light.environments.empty() ? kOwnColumns : widest(light.environments);
    const auto enough = int(std::min(std::ceil(kColumnsPerDeviation * 2 * kPi / deviation), float(width)));
    Environment map = sumOf(light.environments, std::max(enough, std::min(width, kFewestColumns)));
    const float pixel = 2 * kPi / float(map.width);
    if (light.sky) {
        const shared::LightSky model = makeSkyModel(*light.sky);
        forEachPixel(map, [&](vec3& radiance, vec3 d) { radiance += skyRadiance(model, d); });
    }
    for (const Stroke& stroke : light.strokes) {
        const shared::BackgroundDisc disc = discOf(stroke);
        forEachPixel(map, [&](vec3& radiance, vec3 d) {
            radiance = glm::mix(radiance, disc.radiance, coverage(disc, d, pixel));
        });
    }
    if (light.sky && light.sky->hasDisc) addSun(map, sunLamp(*light.sky));
    background.map = std::make_shared<const Environment>(blur(map, deviation));
    return background;
}

} // namespace

vec3 Background::radiance(vec3 direction, float edge) const {
    vec3 sum(0);
    if (map) sum = gain * map->lookup(turnedBy(direction, -rotation));
    if (sky) sum += skyRadiance(*sky, direction);
    for (const shared::BackgroundDisc& stroke : strokes)
        sum = glm::mix(sum, stroke.radiance, coverage(stroke, direction, edge));
    return sum + coverage(sun, direction, edge) * sun.radiance;
}

Background makeBackground(const Light& light, float deviation, const Background& before) {
    RELUME_CHECK(deviation >= 0);
    if (deviation > 0) return blurredBackground(light, deviation, before);
    Background background;
    if (light.environments.size() == 1) {
        const EnvironmentLight& only = light.environments.front();
        background.map = pictureOf(only);
        background.rotation = only.rotation;
        background.gain = only.gain;
    } else if (!light.environments.empty()) {
        // Use the rotation of the first one, so that environments of equal rotation need no resampling.
        background.rotation = light.environments.front().rotation;
        background.environments = light.environments;
        for (EnvironmentLight& each : background.environments) each.rotation -= background.rotation;
        const bool isKnown = before.map && before.environments == background.environments;
        background.map = isKnown ? before.map
                                 : std::make_shared<const Environment>(
                                       sumOf(background.environments, widest(background.environments)));
    }
    if (light.sky) background.sky = makeSkyModel(*light.sky);
    for (const Stroke& stroke : light.strokes) background.strokes.push_back(discOf(stroke));
    if (light.sky && light.sky->hasDisc) background.sun = discOf(sunLamp(*light.sky));
    return background;
}

shared::BackgroundPush makeBackgroundPush(const Background& background, const Camera& camera, float turn,
                                          int width, int height) {
    const vec3 forward = glm::normalize(camera.target - camera.eye);
    // Use directions at unit depth, which are linear in x and y.
    const auto center = [&](int x, int y) {
        const vec3 direction = camera.pixelDirection(x, y, width, height);
        return turnedBy(direction / glm::dot(direction, forward), -turn);
    };
    shared::BackgroundPush push{};
    push.right = (center(width, 0) - center(0, 0)) / float(width);
    push.down = (center(0, height) - center(0, 0)) / float(height);
    push.corner = center(0, 0) - 0.5f * (push.right + push.down);
    push.rotation = background.rotation;
    push.gain = background.map ? background.gain : 0;
    push.hasSky = background.sky.has_value();
    push.strokes = uint32_t(background.strokes.size());
    push.edge = glm::length(push.down);
    // One lookup per map column within a pixel; for the sky two a side, since its horizon is an edge.
    const float columns = background.map ? push.edge * float(background.map->width) / (2 * kPi) : 0;
    push.side = uint32_t(
        std::clamp(std::ceil(columns), background.sky ? 2.0f : 1.0f, float(shared::kMostBackgroundSide)));
    return push;
}

void drawBackground(Image& image, const Background& background, const Camera& camera, float turn) {
    const shared::BackgroundPush push =
        makeBackgroundPush(background, camera, turn, image.width, image.height);
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++) {
            vec4& pixel = image.at(x, y);
            vec3 sum(0);
            const uint32_t lookups = pixel.w < 1 ? push.side * push.side : 0;
            for (uint32_t i = 0; i < lookups; i++) {
                const float u = float(x) + (float(i % push.side) + 0.5f) / float(push.side);
                const float v = float(y) + (float(i / push.side) + 0.5f) / float(push.side);
                sum += background.radiance(glm::normalize(push.corner + u * push.right + v * push.down),
                                           push.edge);
            }
            const float share = (1 - std::min(pixel.w, 1.0f)) / float(std::max(lookups, 1u));
            pixel = vec4(vec3(pixel) + share * sum, 1);
        }
}

} // namespace relume
