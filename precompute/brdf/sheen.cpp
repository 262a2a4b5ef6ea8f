#include "precompute/brdf/sheen.h"

#include "engine/math/disk_map.h"
#include "precompute/brdf/microfacet.h"

namespace relume {

namespace {

// Returns the authors' fit for the masking of their distribution, between its parameters at α = 1 and α = 0.
float maskingFit(float cosine, float alpha) {
    const float narrow = (1 - alpha) * (1 - alpha);
    const auto between = [&](float wide, float thin) { return wide + (thin - wide) * narrow; };
    const float a = between(21.5473f, 25.3245f), b = between(3.82987f, 3.32435f);
    const float c = between(0.19823f, 0.16801f), d = between(-1.97760f, -1.27393f);
    const float e = between(-4.32054f, -4.85967f);
    return a / (1 + b * std::pow(cosine, c)) + d * cosine + e;
}

float lambda(float cosine, float alpha) {
    if (cosine < 0.5f) return std::exp(maskingFit(cosine, alpha));
    return std::exp(2 * maskingFit(0.5f, alpha) - maskingFit(1 - cosine, alpha));
}

float distribution(float sineSquared, float alpha) {
    return (2 + 1 / alpha) * std::pow(sineSquared, 0.5f / alpha) / (2 * kPi);
}

float visibility(float cosine, float otherCosine, float alpha) {
    const float masking = 1 + (lambda(cosine, alpha) + lambda(otherCosine, alpha));
    return 1 / (4 * (cosine * otherCosine) * masking);
}

// Returns the albedo of a white sheen, undivided, within .001: by the midpoint rule, dense at the horizon.
float integrateAlbedo(float cosine, float alpha) {
    constexpr int kSteps = 32;
    const float sine = std::sqrt(1 - cosine * cosine);
    double sum = 0;
    for (int i = 0; i < kSteps; i++) {
        const float place = (float(i) + 0.5f) / kSteps, z = place * place, radius = std::sqrt(1 - z * z);
        double ring = 0;
        for (int j = 0; j < kSteps; j++) {
            const float azimuth = (float(j) + 0.5f) / kSteps * kPi;
            const float x = radius * std::cos(azimuth) + sine, y = radius * std::sin(azimuth);
            const float across = x * x + y * y;
            ring += double(distribution(across / (across + (z + cosine) * (z + cosine)), alpha));
        }
        sum += ring * double(visibility(z, cosine, alpha) * z * 2 * place);
    }
    return float(sum * 2 * double(kPi) / (kSteps * kSteps));
}

} // namespace

Sheen::Sheen(vec3 color, float roughness)
    : mColor(color), mAlpha(std::max(roughness * roughness, kMinAlpha)), mAlbedos{} {
    if (color == vec3(0)) return;
    for (int i = 0; i < kAlbedos; i++) {
        const float root = float(i) / (kAlbedos - 1);
        mAlbedos[size_t(i)] = integrateAlbedo(std::max(root * root, kGrazingCosine), mAlpha);
    }
}

vec3 Sheen::evaluate(vec3 wi, vec3 wo, vec3 half) const {
    if (mColor == vec3(0)) return vec3(0);
    const float excess = std::max({1.0f, albedo(wi.z), albedo(wo.z)});
    const float sineSquared = std::min(half.x * half.x + half.y * half.y, 1.0f);
    return mColor * (distribution(sineSquared, mAlpha) * visibility(wi.z, wo.z, mAlpha) / excess);
}

float Sheen::scaleBelow(vec3 wi, vec3 wo) const {
    if (mColor == vec3(0)) return 1;
    const float largest = std::max({mColor.x, mColor.y, mColor.z});
    return 1 - largest * std::min(std::max(albedo(wi.z), albedo(wo.z)), 1.0f);
}

float Sheen::albedo(float cosine) const {
    const float place = std::sqrt(std::clamp(cosine, 0.0f, 1.0f)) * (kAlbedos - 1);
    const int left = std::min(int(place), kAlbedos - 2);
    const float share = place - float(left);
    return (1 - share) * mAlbedos[size_t(left)] + share * mAlbedos[size_t(left + 1)];
}

} // namespace relume
