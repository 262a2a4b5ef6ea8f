// Conversion of images to latlong maps with samples at pixel centers.
#include "engine/import/environment_file.h"
#include "engine/base/error.h"
#include "engine/base/log.h"
#include "engine/import/image_file.h"
#include "engine/light/environment.h"

#include <OpenEXR/ImfEnvmap.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

// Returns the bilinear value at (x, y), where integers are pixel centers; clamps to the border.
vec3 bilinear(const Image& image, float x, float y) {
    const int x0 = std::clamp(int(x), 0, image.width - 1), x1 = std::min(x0 + 1, image.width - 1);
    const int y0 = std::clamp(int(y), 0, image.height - 1), y1 = std::min(y0 + 1, image.height - 1);
    const float s = std::clamp(x - float(x0), 0.0f, 1.0f), t = std::clamp(y - float(y0), 0.0f, 1.0f);
    return glm::mix(glm::mix(vec3(image.at(x0, y0)), vec3(image.at(x1, y0)), s),
                    glm::mix(vec3(image.at(x0, y1)), vec3(image.at(x1, y1)), s), t);
}

void clampRadiance(Image& image, const std::string& name) {
    size_t negative = 0, bright = 0;
    for (vec4& pixel : image.pixels) {
        const vec3 value(pixel);
        negative += glm::any(glm::lessThan(value, vec3(0)));
        bright += glm::any(glm::greaterThan(value, vec3(kLargestRadiance)));
        pixel = vec4(glm::clamp(value, vec3(0), vec3(kLargestRadiance)), 1);
    }
    if (negative > 0)
        log(LogLevel::Warning,
            fmt::format("{}: {} pixels have negative values; these become 0", name, negative));
    if (bright > 0)
        log(LogLevel::Warning, fmt::format("{}: {} pixels are brighter than {}; they become that", name,
                                           bright, kLargestRadiance));
}

Environment emptyEnvironment(int width, int height) {
    return {width, height, std::vector<vec3>(size_t(width) * size_t(height))};
}

Environment fromPixelCenters(const Image& image) {
    Environment map = emptyEnvironment(image.width, image.height);
    std::copy(image.pixels.begin(), image.pixels.end(), map.radiance.begin());
    return map;
}

// Converts OpenEXR's latlong, whose first and last rows are at the poles and whose first and last columns
// coincide.
Environment fromOpenExrLatLong(const Image& image) {
    Environment map = emptyEnvironment(image.width, image.height);
    for (int y = 0; y < map.height; y++)
        for (int x = 0; x < map.width; x++)
            map.radiance[size_t(y) * size_t(map.width) + size_t(x)] =
                bilinear(image, (float(x) + 0.5f) / float(map.width) * float(image.width - 1),
                         (float(y) + 0.5f) / float(map.height) * float(image.height - 1));
    return map;
}

// Looks up a cube map bilinearly within the face; the outer pixels' centers are on the cube's edges.
vec3 lookupOpenExrCube(const Image& image, vec3 direction) {
    const int faceSize = image.width;
    const Imath::Box2i window({0, 0}, {image.width - 1, image.height - 1});
    Imf::CubeMapFace face;
    Imath::V2f place;
    Imf::CubeMap::faceAndPixelPosition({direction.x, direction.y, direction.z}, window, face, place);
    const int x0 = std::clamp(int(place.x), 0, faceSize - 1), x1 = std::min(x0 + 1, faceSize - 1);
    const int y0 = std::clamp(int(place.y), 0, faceSize - 1), y1 = std::min(y0 + 1, faceSize - 1);
    const auto at = [&](int x, int y) {
        const Imath::V2f pixel = Imf::CubeMap::pixelPosition(face, window, {float(x), float(y)});
        return vec3(image.at(int(std::lround(pixel.x)), int(std::lround(pixel.y))));
    };
    const float s = std::clamp(place.x - float(x0), 0.0f, 1.0f),
                t = std::clamp(place.y - float(y0), 0.0f, 1.0f);
    return glm::mix(glm::mix(at(x0, y0), at(x1, y0), s), glm::mix(at(x0, y1), at(x1, y1), s), t);
}

// Resamples a cube map to four pixels per face width around the equator. Takes 2 × 2 lookups per pixel, since
// towards the cube's corners its pixels are smaller than the map's.
Environment fromOpenExrCube(const Image& image) {
    constexpr int kLookups = 2;
    Environment map = emptyEnvironment(4 * image.width, 2 * image.width);
    for (int y = 0; y < map.height; y++)
        for (int x = 0; x < map.width; x++) {
            vec3 sum(0);
            for (int j = 0; j < kLookups; j++)
                for (int i = 0; i < kLookups; i++)
                    sum += lookupOpenExrCube(image, map.direction(float(x) + (float(i) + 0.5f) / kLookups,
                                                                  float(y) + (float(j) + 0.5f) / kLookups));
            map.radiance[size_t(y) * size_t(map.width) + size_t(x)] = sum / float(kLookups * kLookups);
        }
    return map;
}

} // namespace

Environment readEnvironment(const std::filesystem::path& path) {
    ImageFile file = readImage(path);
    Image& image = file.image;
    const std::string name = path.string();
    clampRadiance(image, name);
    if (file.projection == ImageProjection::Cube) {
        if (int64_t(image.height) != 6 * int64_t(image.width))
            throw Error(
                fmt::format("{}: expected a cube of six faces, one above the other, found {} x {} pixels",
                            name, image.width, image.height));
        return fromOpenExrCube(image);
    }
    if (std::abs(image.width - 2 * image.height) > 2)
        throw Error(
            fmt::format("{}: expected a latitude-longitude map twice as wide as high, found {} x {} pixels; "
                        "convert or crop it",
                        name, image.width, image.height));
    return file.projection == ImageProjection::LatLong ? fromOpenExrLatLong(image) : fromPixelCenters(image);
}

} // namespace relume
