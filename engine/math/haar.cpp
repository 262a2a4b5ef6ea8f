#include "engine/math/haar.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"

#include <algorithm>
#include <bit>
#include <vector>

namespace relume {

void haarForward(std::span<vec3> values, int size) {
    RELUME_CHECK(size > 0 && std::has_single_bit(unsigned(size)));
    RELUME_CHECK_EQ(values.size(), size_t(size) * size_t(size));
    std::vector<vec3> level(values.size());
    for (int half = size / 2; half >= 1; half /= 2) {
        for (int y = 0; y < half; y++)
            for (int x = 0; x < half; x++) {
                const vec3 a = values[(2 * y) * size + 2 * x], b = values[(2 * y) * size + 2 * x + 1];
                const vec3 c = values[(2 * y + 1) * size + 2 * x], d = values[(2 * y + 1) * size + 2 * x + 1];
                level[y * size + x] = 0.5f * (a + b + c + d);
                level[y * size + x + half] = 0.5f * (a - b + c - d);
                level[(y + half) * size + x] = 0.5f * (a + b - c - d);
                level[(y + half) * size + x + half] = 0.5f * (a - b - c + d);
            }
        for (int y = 0; y < 2 * half; y++)
            for (int x = 0; x < 2 * half; x++) values[y * size + x] = level[y * size + x];
    }
}

void haarInverse(std::span<vec3> values, int size) {
    RELUME_CHECK(size > 0 && std::has_single_bit(unsigned(size)));
    RELUME_CHECK_EQ(values.size(), size_t(size) * size_t(size));
    std::vector<vec3> level(values.size());
    for (int half = 1; half < size; half *= 2) {
        for (int y = 0; y < half; y++)
            for (int x = 0; x < half; x++) {
                const vec3 average = values[y * size + x], right = values[y * size + x + half];
                const vec3 down = values[(y + half) * size + x], both = values[(y + half) * size + x + half];
                level[(2 * y) * size + 2 * x] = 0.5f * (average + right + down + both);
                level[(2 * y) * size + 2 * x + 1] = 0.5f * (average - right + down - both);
                level[(2 * y + 1) * size + 2 * x] = 0.5f * (average + right - down - both);
                level[(2 * y + 1) * size + 2 * x + 1] = 0.5f * (average - right - down + both);
            }
        for (int y = 0; y < 2 * half; y++)
            for (int x = 0; x < 2 * half; x++) values[y * size + x] = level[y * size + x];
    }
}

namespace {

void transformFaces(std::span<vec3> cube, int faceSize, void (*transform)(std::span<vec3>, int)) {
    const size_t faceTexels = size_t(faceSize) * size_t(faceSize);
    RELUME_CHECK_EQ(cube.size(), kCubeFaces * faceTexels);
    for (size_t face = 0; face < kCubeFaces; face++)
        transform(cube.subspan(face * faceTexels, faceTexels), faceSize);
}

} // namespace

void haarForwardFaces(std::span<vec3> cube, int faceSize) { transformFaces(cube, faceSize, haarForward); }
void haarInverseFaces(std::span<vec3> cube, int faceSize) { transformFaces(cube, faceSize, haarInverse); }

size_t haarSlot(size_t coefficient, size_t size) {
    const size_t face = coefficient / (size * size), y = coefficient / size % size, x = coefficient % size;
    const size_t level = std::bit_floor(std::max(x, y)); // side of the level's detail blocks
    const size_t detail = (x >= level) + 2 * size_t(y >= level) - 1;
    size_t first = 0;
    for (const size_t side : {size / 4, size / 16, size_t(1)}) {
        const auto place = [&](size_t bx, size_t by, size_t slot) {
            return 16 * (first + (face * side + by) * side + bx) + slot;
        };
        if (level == 2 * side) {
            const size_t qx = x % level, qy = y % level;
            return place(qx / 2, qy / 2, 3 * (qx % 2 + 2 * (qy % 2)) + detail);
        }
        if (level == side) return place(x % level, y % level, 12 + detail);
        first += 6 * side * side;
    }
    return 16 * (first - 6 + face) + 15; // the face's average
}

} // namespace relume
