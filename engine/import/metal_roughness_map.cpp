#include "engine/import/metal_roughness_map.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relume {

namespace {

constexpr size_t kMostNodes = 4; // one per channel of a texture
// kLeastRoughness: below this the model's lobes get no narrower (docs/materials.md).
constexpr float kLeastRoughness = 0.1414f, kEvenMetalness = 0.1f, kEvenRoughness = 1.1f, kStep = 1.6f;

// Histogram of values in [0, 1] in steps of 1/255.
class Histogram {
  public:
    void add(float value) {
        mCounts[size_t(std::lround(255 * std::clamp(value, 0.0f, 1.0f)))]++;
        mSum += value, mAll++;
    }
    float mean() const { return float(mSum / double(mAll)); }
    // Returns the least value that at least this share of all values do not exceed.
    float quantile(double share) const {
        size_t below = 0, value = 0;
        while (value < 255 && double(below += mCounts[value]) < share * double(mAll)) value++;
        return float(value) / 255;
    }

  private:
    std::array<size_t, 256> mCounts{};
    double mSum = 0;
    size_t mAll = 0;
};

constexpr double kLow = 0.02, kHigh = 0.98; // quantiles that nodes span; outliers take the nearest

// Returns ascending roughness levels in equal ratios, as many as the range requires.
std::vector<float> levelsOf(const Histogram& roughness, size_t most) {
    const float low = std::max(roughness.quantile(kLow), kLeastRoughness),
                high = std::max(roughness.quantile(kHigh), kLeastRoughness);
    if (most == 1 || high < kEvenRoughness * low) return {std::max(roughness.mean(), kLeastRoughness)};
    const size_t count =
        std::min(most, 1 + std::max<size_t>(1, size_t(std::ceil(std::log(high / low) / std::log(kStep)))));
    std::vector<float> levels;
    for (size_t i = 0; i < count; i++)
        levels.push_back(low * std::pow(high / low, float(i) / float(count - 1)));
    return levels;
}

// Adds `share` times the interpolation weights of a roughness between levels to the weights at `first`.
void addWeights(std::span<const float> levels, float roughness, float share, float* first) {
    size_t next = 1;
    while (next + 1 < levels.size() && levels[next] < roughness) next++;
    if (levels.size() == 1) {
        first[0] += share;
        return;
    }
    const float low = levels[next - 1], high = levels[next], r = std::clamp(roughness, low, high);
    const float ofHigh = (1 / (low * low) - 1 / (r * r)) / (1 / (low * low) - 1 / (high * high));
    first[next - 1] += share * (1 - ofHigh);
    first[next] += share * ofHigh;
}

} // namespace

std::optional<MetalRoughnessMap> blendMetalRoughness(const Texture& texture, float metallicFactor,
                                                     float roughnessFactor) {
    const auto at = [&](size_t i) {
        const vec4 texel = fetch(texture, int(i % size_t(texture.width)), int(i / size_t(texture.width)));
        return MetalRoughness{metallicFactor * texel.z, roughnessFactor * texel.y};
    };
    Histogram metallic;
    for (size_t i = 0; i < texture.texelCount(); i++) metallic.add(at(i).metallic);
    float low = metallic.quantile(kLow), high = metallic.quantile(kHigh);
    if (high - low < kEvenMetalness) low = high = metallic.mean();
    // First for texels that are not metal, or for all; second for metal.
    std::array<Histogram, 2> roughness;
    const auto isMetal = [&](const MetalRoughness& texel) {
        return low < high && texel.metallic > 0.5f * (low + high);
    };
    for (size_t i = 0; i < texture.texelCount(); i++) {
        const MetalRoughness texel = at(i);
        roughness[isMetal(texel)].add(texel.roughness);
    }
    std::array<std::vector<float>, 2> levels;
    if (low < high) {
        levels[0] = levelsOf(roughness[0], kMostNodes / 2);
        levels[1] = levelsOf(roughness[1], kMostNodes - levels[0].size());
        levels[0] = levelsOf(roughness[0], kMostNodes - levels[1].size());
    } else {
        levels[0] = levelsOf(roughness[0], kMostNodes);
    }
    MetalRoughnessMap map;
    for (const float level : levels[0]) map.nodes.push_back({low, level});
    for (const float level : levels[1]) map.nodes.push_back({high, level});
    if (map.nodes.size() == 1) return std::nullopt;

    map.weights = {texture.width, texture.height, {}, false};
    map.weights.texels.reserve(texture.texelCount());
    for (size_t i = 0; i < texture.texelCount(); i++) {
        const MetalRoughness texel = at(i);
        const float ofMetal =
            low < high ? std::clamp((texel.metallic - low) / (high - low), 0.0f, 1.0f) : 0.0f;
        std::array<float, kMostNodes> weights{};
        addWeights(levels[0], texel.roughness, 1 - ofMetal, weights.data());
        if (ofMetal > 0) addWeights(levels[1], texel.roughness, ofMetal, weights.data() + levels[0].size());
        uint32_t packed = 0;
        for (size_t node = 0; node < kMostNodes; node++)
            packed |= uint32_t(std::lround(255 * weights[node])) << (8 * node);
        map.weights.texels.push_back(packed);
    }
    return map;
}

} // namespace relume
