#include "engine/base/error.h"
#include "engine/math/disk_map.h"
#include "precompute/brdf/models.h"

#include <cmath>

namespace relume {

namespace {

class Plastic final : public Brdf {
  public:
    Plastic(vec3 diffuse, vec3 reflectance, float roughness)
        : mDiffuse(diffuse), mReflectance(reflectance), mRoughness(roughness) {}

    vec3 evaluate(vec3 incoming, vec3 outgoing) const override {
        // Lifted, so that neither the half vector nor a denominator can vanish.
        const vec3 wi = liftAboveHorizon(incoming), wo = liftAboveHorizon(outgoing);
        const auto [half, cosine] = HalfVector(wi, wo);
        const vec3 fresnel = schlickFresnel(mReflectance, cosine);
        const vec3 through =
            (1.0f - schlickFresnel(mReflectance, wi.z)) * (1.0f - schlickFresnel(mReflectance, wo.z));
        return mDiffuse * through / kPi + fresnel * (distribution(half) * visibility(wi.z, wo.z));
    }

    nlohmann::json describe() const override {
        return {{"model", "plastic"},
                {"diffuse", colourToJson(mDiffuse)},
                {"f0", colourToJson(mReflectance)},
                {"roughness", numberToJson(mRoughness)}};
    }

  private:
    // GGX, Walter et al. 2007, equation 33; written without a difference of nearly equal numbers.
    float distribution(vec3 half) const {
        const float squared = mRoughness * mRoughness;
        const float root = half.x * half.x + half.y * half.y + squared * half.z * half.z;
        return squared / (kPi * root * root);
    }

    // G / (4 cosθi cosθo), Heitz 2014, equation 99.
    float visibility(float cosineIn, float cosineOut) const {
        const float squared = mRoughness * mRoughness;
        const auto masked = [&](float cosine) {
            return std::sqrt(squared + (1 - squared) * cosine * cosine);
        };
        return 0.5f / (cosineOut * masked(cosineIn) + cosineIn * masked(cosineOut));
    }

    vec3 mDiffuse, mReflectance;
    float mRoughness;
};

} // namespace

std::unique_ptr<Brdf> makePlastic(MaterialParameters& parameters) {
    const vec3 diffuse = parameters.colour("diffuse", vec3(0.5f), {0, 1});
    vec3 reflectance = parameters.colour("f0", vec3(0.04f), {0, 1});
    const float index = parameters.number("index", 1.5f, {1, 5});
    if (parameters.has("index")) {
        if (parameters.has("f0")) throw UsageError("material plastic: give \"f0\" or \"index\", not both");
        const float ratio = (index - 1) / (index + 1);
        reflectance = vec3(ratio * ratio);
    }
    const float roughness = parameters.number("roughness", 0.2f, {0.02f, 1});
    return std::make_unique<Plastic>(diffuse, reflectance, roughness);
}

} // namespace relume
