#include "engine/math/disk_map.h"
#include "precompute/brdf/microfacet.h"
#include "precompute/brdf/models.h"

namespace relume {

namespace {

class Plastic final : public Brdf {
  public:
    Plastic(vec3 diffuse, vec3 reflectance, float roughness)
        : mDiffuse(diffuse), mReflectance(reflectance), mRoughness(roughness) {}

    vec3 evaluate(vec3 incoming, vec3 outgoing) const override {
        // Lift directions so that neither the half vector nor a denominator can vanish.
        const vec3 wi = liftAboveHorizon(incoming), wo = liftAboveHorizon(outgoing);
        const auto [half, cosine] = HalfVector(wi, wo);
        const Ggx facets{mRoughness, mRoughness};
        return coatedBase(mDiffuse, mReflectance, wi, wo) +
               schlickFresnel(mReflectance, cosine) * (facets.distribution(half) * facets.visibility(wi, wo));
    }

    vec3 evaluateBase(vec3 incoming, vec3 outgoing) const override {
        return coatedBase(mDiffuse, mReflectance, liftAboveHorizon(incoming), liftAboveHorizon(outgoing));
    }

    nlohmann::json describe() const override {
        return {{"model", "plastic"},
                {"diffuse", colorToJson(mDiffuse)},
                {"f0", colorToJson(mReflectance)},
                {"roughness", numberToJson(mRoughness)}};
    }

  private:
    vec3 mDiffuse, mReflectance;
    float mRoughness;
};

} // namespace

std::unique_ptr<Brdf> makePlastic(MaterialParameters& parameters) {
    const vec3 diffuse = parameters.color("diffuse", vec3(0.5f), {0, 1});
    vec3 reflectance = parameters.color("f0", vec3(0.04f), {0, 1});
    const float index = parameters.number("index", 1.5f, {1, 5});
    if (parameters.has("index")) {
        if (parameters.has("f0")) parameters.noteFault("give \"f0\" or \"index\", not both");
        const float ratio = (index - 1) / (index + 1);
        reflectance = vec3(ratio * ratio);
    }
    const float roughness = parameters.number("roughness", 0.2f, {0.02f, 1});
    return std::make_unique<Plastic>(diffuse, reflectance, roughness);
}

} // namespace relume
