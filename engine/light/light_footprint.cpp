#include "engine/light/light_footprint.h"

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/math/cubemap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace relume {

namespace {

// Accumulates weights of a map's pixels for one texel.
class Accumulator {
  public:
    Accumulator(int width, int height)
        : mMap{width, height, {}}, mWeights(size_t(width) * size_t(height), 0.0f) {}

    // Adds a bilinear lookup.
    void add(vec3 direction, float weight) {
        const MapTaps taps = mMap.taps(direction);
        add(taps.x0, taps.y0, weight * (1 - taps.weight.x) * (1 - taps.weight.y));
        add(taps.x1, taps.y0, weight * taps.weight.x * (1 - taps.weight.y));
        add(taps.x0, taps.y1, weight * (1 - taps.weight.x) * taps.weight.y);
        add(taps.x1, taps.y1, weight * taps.weight.x * taps.weight.y);
        mTotal += weight;
    }

    // Appends the pixels with their normalized weights, and resets.
    void flush(std::vector<shared::FootprintPixel>& pixels) {
        std::sort(mTouched.begin(), mTouched.end());
        for (uint32_t pixel : mTouched) {
            const uint32_t x = pixel % uint32_t(mMap.width), y = pixel / uint32_t(mMap.width);
            pixels.push_back({x | y << 16, mWeights[pixel] / mTotal});
            mWeights[pixel] = 0;
        }
        mTouched.clear();
        mTotal = 0;
    }

  private:
    void add(int x, int y, float weight) {
        if (weight <= 0) return;
        const uint32_t pixel = uint32_t(y) * uint32_t(mMap.width) + uint32_t(x);
        if (mWeights[pixel] == 0) mTouched.push_back(pixel);
        mWeights[pixel] += weight;
    }

    Environment mMap; // for its size only
    std::vector<float> mWeights;
    std::vector<uint32_t> mTouched;
    float mTotal = 0;
};

// Faces by the axes that they look along.
constexpr int kPlusX = 0, kMinusX = 1, kPlusY = 2, kMinusY = 3, kPlusZ = 4, kMinusZ = 5;

// Returns the footprints of one face, by sampling.
LightFootprints sampleFace(int face, int width, int height, int size) {
    LightFootprints footprints{.width = width, .height = height, .size = size, .starts = {0}, .pixels = {}};
    const int count = samplesPerTexelSide(width, size);
    Accumulator weights(width, height);
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
            forEachSubCell(face, x, y, size, count,
                           [&](vec3 direction, float weight) { weights.add(direction, weight); });
            weights.flush(footprints.pixels);
            footprints.starts.push_back(uint32_t(footprints.pixels.size()));
        }
    return footprints;
}

// Returns the footprints of a side face from those of another, so many quarter turns about +Y further. The
// width is a multiple of four.
LightFootprints turned(LightFootprints face, int quarters) {
    const auto width = uint32_t(face.width), shift = width - width / 4 * uint32_t(quarters);
    for (shared::FootprintPixel& pixel : face.pixels)
        pixel.place = ((pixel.place & 0xffff) + shift) % width | (pixel.place & 0xffff0000);
    for (size_t texel = 1; texel < face.starts.size(); texel++)
        std::ranges::sort(face.pixels.begin() + face.starts[texel - 1],
                          face.pixels.begin() + face.starts[texel], {}, &shared::FootprintPixel::place);
    return face;
}

// Returns the footprints of one pole's face from those of the other's: rows of the face and of the map are
// reversed.
LightFootprints mirrored(const LightFootprints& face) {
    LightFootprints mirror{
        .width = face.width, .height = face.height, .size = face.size, .starts = {0}, .pixels = {}};
    const auto lastRow = uint32_t(face.height - 1);
    for (int y = face.size - 1; y >= 0; y--)
        for (int x = 0; x < face.size; x++) {
            const size_t texel = size_t(y * face.size + x), first = mirror.pixels.size();
            for (uint32_t i = face.starts[texel]; i < face.starts[texel + 1]; i++) {
                const shared::FootprintPixel& pixel = face.pixels[i];
                mirror.pixels.push_back(
                    {(pixel.place & 0xffff) | (lastRow - (pixel.place >> 16)) << 16, pixel.weight});
            }
            std::ranges::sort(mirror.pixels.begin() + std::ptrdiff_t(first), mirror.pixels.end(), {},
                              &shared::FootprintPixel::place);
            mirror.starts.push_back(uint32_t(mirror.pixels.size()));
        }
    return mirror;
}

} // namespace

int samplesPerTexelSide(int environmentWidth, int cubeSize) {
    RELUME_CHECK(environmentWidth > 0 && cubeSize > 0);
    const double widestTexel = 2.0 / cubeSize, pixel = 2 * double(kPi) / environmentWidth;
    return std::max(2, int(std::ceil(5 * widestTexel / pixel)));
}

LightFootprints makeLightFootprints(int width, int height, int size) {
    RELUME_CHECK(width > 0 && width <= 65536 && height > 0 && height <= 65536 && size > 0);
    // A map of 512 x 256 keeps a thread busy for 0.06 s a face, while somebody waits for the first picture.
    std::array<LightFootprints, kCubeFaces> faces;
    const auto sample = [&](std::span<const int> some) {
        parallelFor(some.size(),
                    [&](size_t i) { faces[size_t(some[i])] = sampleFace(some[i], width, height, size); });
    };
    if (width % 4 == 0) {
        sample(std::array{kPlusY, kPlusZ});
        faces[kMinusY] = mirrored(faces[kPlusY]);
        faces[kPlusX] = turned(faces[kPlusZ], 1);
        faces[kMinusZ] = turned(faces[kPlusZ], 2);
        faces[kMinusX] = turned(faces[kPlusZ], 3);
    } else {
        sample(std::array{kPlusX, kMinusX, kPlusY, kMinusY, kPlusZ, kMinusZ});
    }
    LightFootprints all{.width = width, .height = height, .size = size, .starts = {0}, .pixels = {}};
    for (const LightFootprints& face : faces) {
        const auto before = uint32_t(all.pixels.size());
        for (const uint32_t start : std::span(face.starts).subspan(1)) all.starts.push_back(before + start);
        all.pixels.insert(all.pixels.end(), face.pixels.begin(), face.pixels.end());
    }
    return all;
}

ColumnShift columnShift(float rotation, int width) {
    RELUME_CHECK(std::isfinite(rotation));
    const double turns = double(rotation) / (2 * 3.14159265358979323846);
    const double columns = (turns - std::floor(turns)) * width;
    const double whole = std::floor(columns);
    return {uint32_t(whole) % uint32_t(width), float(columns - whole)};
}

} // namespace relume
