#include "engine/light/light_footprint.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"

#include <algorithm>
#include <cmath>
#include <future>

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

} // namespace

int samplesPerTexelSide(int environmentWidth, int cubeSize) {
    RELUME_CHECK(environmentWidth > 0 && cubeSize > 0);
    const double widestTexel = 2.0 / cubeSize, pixel = 2 * double(kPi) / environmentWidth;
    return std::max(2, int(std::ceil(5 * widestTexel / pixel)));
}

LightFootprints makeLightFootprints(int width, int height, int size) {
    RELUME_CHECK(width > 0 && width <= 65536 && height > 0 && height <= 65536 && size > 0);
    LightFootprints footprints{.width = width, .height = height, .size = size, .starts = {0}, .pixels = {}};
    const int count = samplesPerTexelSide(width, size);
    const auto ofFace = [&](int face) {
        LightFootprints own;
        Accumulator weights(width, height);
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++) {
                forEachSubCell(face, x, y, size, count,
                               [&](vec3 direction, float weight) { weights.add(direction, weight); });
                weights.flush(own.pixels);
                own.starts.push_back(uint32_t(own.pixels.size()));
            }
        return own;
    };
    // A thread per face: a map of 1024 x 512 keeps one busy for 0.3 s, while somebody waits for the first
    // picture.
    std::vector<std::future<LightFootprints>> faces;
    for (int face = 0; face < kCubeFaces; face++)
        faces.push_back(std::async(std::launch::async, ofFace, face));
    for (std::future<LightFootprints>& face : faces) {
        const LightFootprints own = face.get();
        const auto before = uint32_t(footprints.pixels.size());
        for (const uint32_t start : own.starts) footprints.starts.push_back(before + start);
        footprints.pixels.insert(footprints.pixels.end(), own.pixels.begin(), own.pixels.end());
    }
    return footprints;
}

ColumnShift columnShift(float rotation, int width) {
    RELUME_CHECK(std::isfinite(rotation));
    const double turns = double(rotation) / (2 * 3.14159265358979323846);
    const double columns = (turns - std::floor(turns)) * width;
    const double whole = std::floor(columns);
    return {uint32_t(whole) % uint32_t(width), float(columns - whole)};
}

} // namespace relume
