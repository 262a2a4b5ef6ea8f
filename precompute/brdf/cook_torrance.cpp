#include "engine/math/disk_map.h"
#include "precompute/brdf/microfacet.h"
#include "precompute/brdf/models.h"

namespace relume {

namespace {

class CookTorrance final : public Brdf {
  public:
    CookTorrance(vec3 diffuse, vec3 reflectance, float roughness)
        : mDiffuse(diffuse), mReflectance(reflectance), mRoughness(roughness) {}

    vec3 evaluate(vec3 incoming, vec3 outgoing) const override {
        // Lift directions so that neither the half vector nor a denominator can vanish.
        const vec3 wi = liftAboveHorizon(incoming), wo = liftAboveHorizon(outgoing);
        const auto [half, cosine] = HalfVector(wi, wo);
        const float facets = distribution(half) * visibility(wi.z, wo.z, half.z, cosine);
        return coatedBase(mDiffuse, mReflectance, wi, wo) + schlickFresnel(mReflectance, cosine) * facets;
    }

    vec3 evaluateBase(vec3 incoming, vec3 outgoing) const override {
        return coatedBase(mDiffuse, mReflectance, liftAboveHorizon(incoming), liftAboveHorizon(outgoing));
    }

    nlohmann::json describe() const override {
        return {{"model", "cook-torrance"},
                {"diffuse", colorToJson(mDiffuse)},
                {"f0", colorToJson(mReflectance)},
                {"roughness", numberToJson(mRoughness)}};
    }

  private:
    // Beckmann's distribution (Walter et al. 2007, equation 25).
    float distribution(vec3 half) const {
        const float squared = mRoughness * mRoughness, cosineSquared = half.z * half.z;
        const float slope = (half.x * half.x + half.y * half.y) / (squared * cosineSquared);
        return std::exp(-slope) / (kPi * squared * cosineSquared * cosineSquared);
    }

    // G / (4 cosθi cosθo), with G = min(1, 2 cosθh cosθi / cosα, 2 cosθh cosθo / cosα).
    static float visibility(float cosineIn, float cosineOut, float cosineHalf, float cosine) {
        return std::min(0.25f / (cosineIn * cosineOut),
                        0.5f * cosineHalf / (cosine * std::max(cosineIn, cosineOut)));
    }

    vec3 mDiffuse, mReflectance;
    float mRoughness;
};

} // namespace

std::unique_ptr<Brdf> makeCookTorrance(MaterialParameters& parameters) {
    const vec3 diffuse = parameters.color("diffuse", vec3(0.3f), {0, 1});
    const vec3 reflectance = parameters.color("f0", vec3(0.04f), {0, 1});
    const float roughness = parameters.number("roughness", 0.3f, {0.02f, 1});
    return std::make_unique<CookTorrance>(diffuse, reflectance, roughness);
}

} // namespace relume
