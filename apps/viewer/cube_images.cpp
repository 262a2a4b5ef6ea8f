#include "apps/viewer/cube_images.h"

#include "engine/base/check.h"
#include "engine/light/light.h"
#include "engine/math/cubemap.h"

#include <cmath>

namespace relume {

namespace {

// A face of the cross: its column and row, and its axes in world space.
struct CrossFace {
    int column, row;
    vec3 forward, right, down;
};

constexpr CrossFace kCross[] = {
    {0, 1, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}},   {1, 1, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}},
    {2, 1, {-1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {3, 1, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}},
    {1, 0, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},   {1, 2, {0, -1, 0}, {-1, 0, 0}, {0, 0, -1}},
};

vec3 radianceAt(const LightCube& cube, vec3 direction) {
    const CubeTexel texel = cubeTexel(direction, cube.size);
    return cube.radiance[size_t(cubeTexelIndex(texel.face, texel.x, texel.y, cube.size))];
}

} // namespace

MapAngles anglesAt(vec2 place) { return {180 - 360 * place.x, 90 - 180 * place.y}; }

Image latlongOf(const LightCube& cube, int width) {
    Image image(width, width / 2);
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < width; x++) {
            const MapAngles angles =
                anglesAt({(float(x) + 0.5f) / float(width), (float(y) + 0.5f) / float(image.height)});
            image.at(x, y) = vec4(radianceAt(cube, directionAt(angles.azimuth, angles.elevation)), 1);
        }
    return image;
}

Image crossOf(const LightCube& cube, int scale) {
    const int side = cube.size * scale;
    Image image(4 * side, 3 * side);
    for (const CrossFace& face : kCross)
        for (int y = 0; y < side; y++)
            for (int x = 0; x < side; x++) {
                const float u = (2 * float(x) + 1) / float(side) - 1,
                            v = (2 * float(y) + 1) / float(side) - 1;
                image.at(face.column * side + x, face.row * side + y) =
                    vec4(radianceAt(cube, face.forward + u * face.right + v * face.down), 1);
            }
    return image;
}

Image thumbnailOf(const Environment& map, int width, int height) {
    RELUME_CHECK(width > 0 && height > 0);
    Image image(width, height);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const int left = x * map.width / width, right = std::max(left + 1, (x + 1) * map.width / width);
            const int top = y * map.height / height,
                      bottom = std::max(top + 1, (y + 1) * map.height / height);
            vec3 sum(0);
            for (int row = top; row < bottom; row++)
                for (int column = left; column < right; column++)
                    sum += map.radiance[size_t(row) * size_t(map.width) + size_t(column)];
            image.at(x, y) = vec4(sum / float((right - left) * (bottom - top)), 1);
        }
    return image;
}

} // namespace relume
