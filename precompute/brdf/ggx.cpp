#include "engine/math/disk_map.h"
#include "precompute/brdf/microfacet.h"
#include "precompute/brdf/models.h"

namespace relume {

namespace {

class GgxConductor final : public Brdf {
  public:
    GgxConductor(vec3 reflectance, Ggx facets) : mReflectance(reflectance), mFacets(facets) {}

    vec3 evaluate(vec3 incoming, vec3 outgoing) const override {
        // Lift directions so that neither the half vector nor a denominator can vanish.
        const vec3 wi = liftAboveHorizon(incoming), wo = liftAboveHorizon(outgoing);
        const auto [half, cosine] = HalfVector(wi, wo);
        return schlickFresnel(mReflectance, cosine) *
               (mFacets.distribution(half) * mFacets.visibility(wi, wo));
    }

    bool isIsotropic() const override { return mFacets.alphaU == mFacets.alphaV; }

    nlohmann::json describe() const override {
        return {{"model", "ggx"},
                {"f0", colorToJson(mReflectance)},
                {"roughness_u", numberToJson(mFacets.alphaU)},
                {"roughness_v", numberToJson(mFacets.alphaV)}};
    }

  private:
    vec3 mReflectance;
    Ggx mFacets;
};

} // namespace

std::unique_ptr<Brdf> makeGgx(MaterialParameters& parameters) {
    const vec3 reflectance = parameters.color("f0", vec3(0.9f), {0, 1});
    Ggx facets;
    facets.alphaU = parameters.number("roughness_u", 0.2f, {0.02f, 1});
    facets.alphaV = parameters.number("roughness_v", 0.2f, {0.02f, 1});
    return std::make_unique<GgxConductor>(reflectance, facets);
}

} // namespace relume
