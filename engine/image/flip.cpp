// Constants are from the paper (see the header) and its authors' reference implementation.
#include "engine/image/flip.h"

#include "engine/base/check.h"
#include "engine/math/color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace relume {

namespace {

constexpr float kPixelsPerDegree = 67;

// --- Colors: linear RGB, XYZ relative to the white of D65, YyCxCz, Hunt-adjusted L*a*b*.

// Converts linear sRGB to XYZ. Each row is divided by its sum, so that white is (1, 1, 1).
const mat3 kRgbToXyz = [] {
    mat3 m(0.4124564f, 0.2126729f, 0.0193339f, 0.3575761f, 0.7151522f, 0.1191920f, 0.1804375f, 0.0721750f,
           0.9503041f);
    const vec3 white = m * vec3(1);
    for (int c = 0; c < 3; c++) m[c] /= white;
    return m;
}();
const mat3 kXyzToRgb = glm::inverse(kRgbToXyz);

vec3 opponentOfXyz(vec3 xyz) { return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)}; }

vec3 xyzOfOpponent(vec3 opponent) {
    const float y = (opponent.x + 16) / 116;
    return {y + opponent.y / 500, y, y - opponent.z / 200};
}

// Returns Hunt-adjusted L*a*b*: L*a*b* whose a* and b* are scaled by lightness, since colors matter less in
// the dark.
vec3 huntLabOfRgb(vec3 rgb) {
    vec3 root = kRgbToXyz * rgb;
    for (int c = 0; c < 3; c++) {
        constexpr float kDelta = 6.0f / 29;
        root[c] = root[c] > kDelta * kDelta * kDelta ? std::cbrt(root[c])
                                                     : root[c] / (3 * kDelta * kDelta) + 4.0f / 29;
    }
    const vec3 lab = opponentOfXyz(root);
    return {lab.x, 0.01f * lab.x * lab.y, 0.01f * lab.x * lab.z};
}

// Returns the HyAB distance: city-block in lightness, Euclidean in color.
float hyab(vec3 a, vec3 b) {
    const vec3 difference = a - b;
    return std::abs(difference.x) + std::hypot(difference.y, difference.z);
}

// --- Separable filters. Beyond the border the image repeats its border pixels.

struct Plane {
    int width, height;
    std::vector<float> values;
};

using Kernel = std::vector<float>; // 2 · radius + 1 weights

// Filters along rows (dx = 1, dy = 0) or columns (dx = 0, dy = 1).
Plane filterAlong(const Plane& plane, const Kernel& kernel, int dx, int dy) {
    const int radius = int(kernel.size()) / 2;
    Plane result = plane;
    for (int y = 0; y < plane.height; y++)
        for (int x = 0; x < plane.width; x++) {
            float sum = 0;
            for (int i = -radius; i <= radius; i++) {
                const int column = std::clamp(x + i * dx, 0, plane.width - 1);
                const int row = std::clamp(y + i * dy, 0, plane.height - 1);
                sum += kernel[size_t(i + radius)] *
                       plane.values[size_t(row) * size_t(plane.width) + size_t(column)];
            }
            result.values[size_t(y) * size_t(plane.width) + size_t(x)] = sum;
        }
    return result;
}

Plane filterSeparably(const Plane& plane, const Kernel& horizontal, const Kernel& vertical) {
    return filterAlong(filterAlong(plane, horizontal, 1, 0), vertical, 0, 1);
}

template <typename Weight>
Kernel makeKernel(int radius, Weight weight) {
    Kernel kernel;
    for (int i = -radius; i <= radius; i++) kernel.push_back(weight(float(i)));
    return kernel;
}

float sumOf(const Kernel& kernel) {
    float sum = 0;
    for (float weight : kernel) sum += weight;
    return sum;
}

// --- Color pipeline.

// Gaussian of a contrast sensitivity function: a √(π / b) exp(-π² x² / b), x in degrees.
struct Sensitivity {
    float a, b;
};
constexpr Sensitivity kAchromatic = {1, 0.0047f}, kRedGreen = {1, 0.0053f};
constexpr Sensitivity kBlueYellow[] = {{34.1f, 0.04f}, {13.5f, 0.025f}};

Kernel sensitivityKernel(float b) {
    const int radius = int(std::ceil(3 * std::sqrt(0.04f / (2 * kPi * kPi)) * kPixelsPerDegree));
    return makeKernel(radius, [b](float i) {
        const float degrees = i / kPixelsPerDegree;
        return std::exp(-kPi * kPi * degrees * degrees / b);
    });
}

// Filters by the sum of the given Gaussians, normalized to a total weight of 1.
Plane filterBySensitivity(const Plane& plane, std::initializer_list<Sensitivity> terms) {
    Plane result{plane.width, plane.height, std::vector<float>(plane.values.size(), 0.0f)};
    float total = 0;
    for (const Sensitivity& term : terms) {
        const Kernel kernel = sensitivityKernel(term.b);
        const float weight = term.a * std::sqrt(kPi / term.b);
        total += weight * sumOf(kernel) * sumOf(kernel);
        const Plane filtered = filterSeparably(plane, kernel, kernel);
        for (size_t i = 0; i < result.values.size(); i++) result.values[i] += weight * filtered.values[i];
    }
    for (float& value : result.values) value /= total;
    return result;
}

// Returns what the eye resolves of an image, in Hunt-adjusted L*a*b*.
std::vector<vec3> perceivedColors(const std::array<Plane, 3>& opponent) {
    const Plane achromatic = filterBySensitivity(opponent[0], {kAchromatic});
    const Plane redGreen = filterBySensitivity(opponent[1], {kRedGreen});
    const Plane blueYellow = filterBySensitivity(opponent[2], {kBlueYellow[0], kBlueYellow[1]});
    std::vector<vec3> colors(achromatic.values.size());
    for (size_t i = 0; i < colors.size(); i++) {
        const vec3 filtered(achromatic.values[i], redGreen.values[i], blueYellow.values[i]);
        const vec3 rgb = kXyzToRgb * xyzOfOpponent(filtered);
        colors[i] = huntLabOfRgb(glm::clamp(rgb, vec3(0), vec3(1)));
    }
    return colors;
}

// Returns a color error: the HyAB distance to the power 0.7, remapped so that 0.4 of the largest becomes
// 0.95.
float colorError(vec3 a, vec3 b) {
    constexpr float kExponent = 0.7f, kKnee = 0.4f, kKneeError = 0.95f;
    static const float largest =
        std::pow(hyab(huntLabOfRgb(vec3(0, 1, 0)), huntLabOfRgb(vec3(0, 0, 1))), kExponent);
    const float distance = std::pow(hyab(a, b), kExponent);
    const float knee = kKnee * largest;
    return distance < knee ? kKneeError * distance / knee
                           : kKneeError + (distance - knee) / (largest - knee) * (1 - kKneeError);
}

// --- Feature pipeline.

// Scales positive weights to sum to 1, negative ones to sum to -1.
Kernel normalizeBySign(Kernel kernel) {
    float positive = 0, negative = 0;
    for (float weight : kernel) (weight > 0 ? positive : negative) += std::abs(weight);
    for (float& weight : kernel) weight /= weight > 0 ? positive : negative;
    return kernel;
}

// Returns the magnitude of the responses to a filter that is `across` along one axis and the Gaussian `along`
// along the other.
std::vector<float> featureStrength(const Plane& plane, const Kernel& across, const Kernel& along) {
    const Plane x = filterSeparably(plane, across, along), y = filterSeparably(plane, along, across);
    std::vector<float> strength(plane.values.size());
    for (size_t i = 0; i < strength.size(); i++) strength[i] = std::hypot(x.values[i], y.values[i]);
    return strength;
}

struct Features {
    std::vector<float> edges, points;
};

// Detects edges and points by the first and second derivatives of a Gaussian. The first derivative is 0.082
// degrees wide from peak to trough.
Features detectFeatures(Plane opponentY) {
    for (float& value : opponentY.values) value = (value + 16) / 116;
    const float deviation = 0.5f * 0.082f * kPixelsPerDegree;
    const int radius = int(std::ceil(3 * deviation));
    const auto gauss = [=](float i) { return std::exp(-i * i / (2 * deviation * deviation)); };
    Kernel along = makeKernel(radius, gauss);
    const float sum = sumOf(along);
    for (float& weight : along) weight /= sum;
    const Kernel edge = makeKernel(radius, [&](float i) { return -i * gauss(i); });
    const Kernel point =
        makeKernel(radius, [&](float i) { return (i * i / (deviation * deviation) - 1) * gauss(i); });
    return {featureStrength(opponentY, normalizeBySign(edge), along),
            featureStrength(opponentY, normalizeBySign(point), along)};
}

float featureError(const Features& a, const Features& b, size_t i) {
    const float difference = std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i]));
    return std::sqrt(difference / std::sqrt(2.0f));
}

std::array<Plane, 3> opponentPlanes(const Image& image) {
    std::array<Plane, 3> planes;
    for (Plane& plane : planes) plane = {image.width, image.height, {}};
    for (const vec4& pixel : image.pixels) {
        const vec3 rgb(decodeSrgb(pixel.x), decodeSrgb(pixel.y), decodeSrgb(pixel.z));
        const vec3 opponent = opponentOfXyz(kRgbToXyz * rgb);
        for (int c = 0; c < 3; c++) planes[size_t(c)].values.push_back(opponent[c]);
    }
    return planes;
}

} // namespace

double flipError(const Image& a, const Image& b) {
    RELUME_CHECK(a.width == b.width && a.height == b.height && !a.pixels.empty());
    const std::array<Plane, 3> planesA = opponentPlanes(a), planesB = opponentPlanes(b);
    const std::vector<vec3> colorsA = perceivedColors(planesA), colorsB = perceivedColors(planesB);
    const Features featuresA = detectFeatures(planesA[0]), featuresB = detectFeatures(planesB[0]);
    double sum = 0;
    for (size_t i = 0; i < colorsA.size(); i++)
        sum += std::pow(colorError(colorsA[i], colorsB[i]), 1 - featureError(featuresA, featuresB, i));
    return sum / double(colorsA.size());
}

} // namespace relume
