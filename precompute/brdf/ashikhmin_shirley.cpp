#include "engine/math/disk_map.h"
#include "precompute/brdf/microfacet.h"
#include "precompute/brdf/models.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

class AshikhminShirley final : public Brdf {
  public:
    AshikhminShirley(vec3 diffuse, vec3 specular, float exponentU, float exponentV)
        : mDiffuse(diffuse), mSpecular(specular), mExponentU(exponentU), mExponentV(exponentV) {}

    vec3 evaluate(vec3 incoming, vec3 outgoing) const override {
        // Lift directions so that neither the half vector nor a denominator can vanish.
        const vec3 wi = liftAboveHorizon(incoming), wo = liftAboveHorizon(outgoing);
        return specular(wi, wo) + diffuse(wi, wo);
    }

    vec3 evaluateBase(vec3 incoming, vec3 outgoing) const override {
        return diffuse(liftAboveHorizon(incoming), liftAboveHorizon(outgoing));
    }

    bool isIsotropic() const override { return mExponentU == mExponentV; }

    nlohmann::json describe() const override {
        return {{"model", "ashikhmin-shirley"},
                {"kd", colorToJson(mDiffuse)},
                {"ks", colorToJson(mSpecular)},
                {"nu", numberToJson(mExponentU)},
                {"nv", numberToJson(mExponentV)}};
    }

  private:
    // Equation 4 of the paper.
    vec3 specular(vec3 wi, vec3 wo) const {
        const auto [half, cosine] = HalfVector(wi, wo);
        // cosʲ of the half angle as exp(j/2 · log(1 - sin²)), which stays precise near the peak.
        const float sineSquared = half.x * half.x + half.y * half.y;
        const float weighted = mExponentU * half.x * half.x + mExponentV * half.y * half.y;
        const float slope =
            sineSquared > 1e-12f ? std::log1p(-std::min(sineSquared, 0.999999f)) / sineSquared : -1.0f;
        const float lobe = std::exp(0.5f * weighted * slope);
        const float scale = std::sqrt((mExponentU + 1) * (mExponentV + 1)) / (8 * kPi);
        return schlickFresnel(mSpecular, cosine) * (scale * lobe / (cosine * std::max(wi.z, wo.z)));
    }

    // Equation 5. It is not Lambertian, so that diffuse and specular together conserve energy.
    vec3 diffuse(vec3 wi, vec3 wo) const {
        const auto transmitted = [](float cosine) {
            const float rest = 1 - cosine / 2;
            return 1 - rest * rest * rest * rest * rest;
        };
        return mDiffuse * (1.0f - mSpecular) * (28 / (23 * kPi) * transmitted(wi.z) * transmitted(wo.z));
    }

    vec3 mDiffuse, mSpecular;
    float mExponentU, mExponentV;
};

} // namespace

std::unique_ptr<Brdf> makeAshikhminShirley(MaterialParameters& parameters) {
    const vec3 diffuse = parameters.color("kd", vec3(0.5f), {0, 1});
    const vec3 specular = parameters.color("ks", vec3(0.75f), {0, 1});
    const float exponentU = parameters.number("nu", 10, {0, 1e5f});
    const float exponentV = parameters.number("nv", 100, {0, 1e5f});
    return std::make_unique<AshikhminShirley>(diffuse, specular, exponentU, exponentV);
}

} // namespace relume
