#include "precompute/twins/transport_twin.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"
#include "engine/math/haar.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace relume {

std::vector<uint8_t> visibilityCube(const RayTracer& tracer, vec3 origin, vec3 normal, int size) {
    // Trace in tiles of 16 × 16: neighboring rays trace faster together.
    const int tile = std::min(size, 16);
    RELUME_CHECK(size > 0 && size % tile == 0);
    std::vector<uint8_t> visibility(size_t(kCubeFaces) * size_t(size) * size_t(size), 0);
    std::vector<vec3> directions;
    std::vector<size_t> texels;
    std::array<uint8_t, 256> blocked;
    for (int face = 0; face < kCubeFaces; face++)
        for (int top = 0; top < size; top += tile)
            for (int left = 0; left < size; left += tile) {
                directions.clear(), texels.clear();
                for (int y = top; y < top + tile; y++)
                    for (int x = left; x < left + tile; x++) {
                        const vec3 direction = cubeTexelDirection(face, x, y, size);
                        if (!(glm::dot(direction, normal) > 0)) continue;
                        directions.push_back(direction);
                        texels.push_back(size_t(cubeTexelIndex(face, x, y, size)));
                    }
                tracer.occluded(origin, directions, std::span(blocked).first(directions.size()));
                for (size_t i = 0; i < texels.size(); i++) visibility[texels[i]] = blocked[i] ? 0 : 1;
            }
    return visibility;
}

namespace {

// Returns the share of ones in a square of `side` texels that starts at (x, y).
float visibleFraction(const std::vector<uint8_t>& visibility, int size, int face, int x, int y, int side) {
    int visible = 0;
    for (int row = y; row < y + side; row++)
        for (int column = x; column < x + side; column++)
            visible += visibility[size_t(cubeTexelIndex(face, column, row, size))];
    return float(visible) / float(side * side);
}

} // namespace

std::vector<vec3> transportVector(const std::vector<uint8_t>& visibility, int visibilitySize, int faceSize,
                                  int samples, const FactoredBrdf& brdf, int term,
                                  const TangentFrame& frame) {
    const int cells = int(std::lround(std::sqrt(double(samples)))); // cells per side of a lighting texel
    RELUME_CHECK_EQ(cells * cells, samples);
    const int cellFaceSize = faceSize * cells; // cells per side of a face
    RELUME_CHECK(cellFaceSize > 0 && visibilitySize % cellFaceSize == 0);
    RELUME_CHECK_EQ(visibility.size(), size_t(kCubeFaces) * size_t(visibilitySize) * size_t(visibilitySize));
    RELUME_CHECK(term >= 0 && term < brdf.terms);
    const int cellSide = visibilitySize / cellFaceSize; // visibility texels per side of a cell
    const vec3* lightMap = &brdf.lightMaps[size_t(term) * brdf.mapTexels()];

    std::vector<vec3> transport(size_t(kCubeFaces) * size_t(faceSize) * size_t(faceSize), vec3(0));
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < cellFaceSize; y++)
            for (int x = 0; x < cellFaceSize; x++) {
                const vec3 local = frame.toLocal(cubeTexelDirection(face, x, y, cellFaceSize));
                if (!(local.z > 0)) continue;
                const float fraction =
                    visibleFraction(visibility, visibilitySize, face, x * cellSide, y * cellSide, cellSide);
                const float weight = local.z * cubeTexelSolidAngle(x, y, cellFaceSize) * fraction;
                transport[size_t(cubeTexelIndex(face, x / cells, y / cells, faceSize))] +=
                    lookupMap(lightMap, brdf.size, brdf.mapping, local) * weight;
            }
    return transport;
}

std::vector<uint16_t> selectLargest(const std::vector<vec3>& coefficients, int count) {
    RELUME_CHECK(count >= 0);
    RELUME_CHECK_LE(coefficients.size(), size_t(std::numeric_limits<uint16_t>::max()) + 1);
    // Evaluate in float from left to right, as the kernel does, so that both break ties alike.
    const auto key = [&](uint16_t index) {
        const vec3& c = coefficients[index];
        return c.x * c.x + c.y * c.y + c.z * c.z;
    };
    std::vector<uint16_t> selected;
    for (size_t i = 0; i < coefficients.size(); i++)
        if (key(uint16_t(i)) > 0) selected.push_back(uint16_t(i));
    if (selected.size() > size_t(count)) {
        const auto isLarger = [&](uint16_t a, uint16_t b) {
            const float keyA = key(a), keyB = key(b);
            return keyA > keyB || (keyA == keyB && a < b);
        };
        std::nth_element(selected.begin(), selected.begin() + count, selected.end(), isLarger);
        selected.resize(size_t(count));
        std::sort(selected.begin(), selected.end());
    }
    return selected;
}

PackedRow packRow(const std::vector<vec3>& coefficients, const std::vector<uint16_t>& selected) {
    PackedRow row;
    for (uint16_t index : selected) {
        const vec3 magnitude = glm::abs(coefficients[index]);
        row.scale = std::max({row.scale, magnitude.x, magnitude.y, magnitude.z});
    }
    for (uint16_t index : selected) {
        const ivec3 quantized = quantizeCoefficient(coefficients[index], row.scale);
        if (quantized == ivec3(0)) continue;
        row.indices.push_back(index);
        row.values.push_back(packCoefficient(quantized));
    }
    return row;
}

} // namespace relume
