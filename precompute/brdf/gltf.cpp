#include "engine/math/disk_map.h"
#include "precompute/brdf/microfacet.h"
#include "precompute/brdf/models.h"

namespace relume {

namespace {

constexpr float kDielectric = 0.04f; // F0 of index 1.5, as the specification has it
constexpr float kMinAlpha = 0.02f;

class Gltf final : public Brdf {
  public:
    Gltf(vec3 baseColor, float metallic, float roughness)
        : mBaseColor(baseColor), mMetallic(metallic), mRoughness(roughness),
          mAlpha(std::max(roughness * roughness, kMinAlpha)) {}

    vec3 evaluate(vec3 incoming, vec3 outgoing) const override {
        const Geometry geometry(incoming, outgoing, mAlpha);
        return base(geometry) + vec3(rest(geometry));
    }

    vec3 evaluateBase(vec3 incoming, vec3 outgoing) const override {
        return base(Geometry(incoming, outgoing, mAlpha));
    }

    nlohmann::json describe() const override {
        return {{"model", "gltf"},
                {"base_color", colorToJson(mBaseColor)},
                {"metallic", numberToJson(mMetallic)},
                {"roughness", numberToJson(mRoughness)}};
    }

  private:
    // Terms of two directions that both parts use.
    struct Geometry {
        float facets;  // D V
        float weight;  // (1 - h·ωo)⁵
        float through; // of the base under the coat

        Geometry(vec3 incoming, vec3 outgoing, float alpha) {
            // Lifted, so that neither the half vector nor a denominator can vanish.
            const vec3 wi = liftAboveHorizon(incoming), wo = liftAboveHorizon(outgoing);
            const auto [half, cosine] = HalfVector(wi, wo);
            const Ggx ggx{alpha, alpha};
            facets = ggx.distribution(half) * ggx.visibility(wi, wo);
            weight = schlickWeight(cosine);
            through = (1 - kDielectric) * (1 - schlickWeight(wi.z)) * (1 - schlickWeight(wo.z));
        }
    };

    // Linear in the base color: the diffuse base, and F0 of the metal in c (1 - w) + w.
    vec3 base(const Geometry& geometry) const {
        return mBaseColor * ((1 - mMetallic) * geometry.through / kPi +
                             mMetallic * (1 - geometry.weight) * geometry.facets);
    }

    // The coat, and what a metal of any color reflects.
    float rest(const Geometry& geometry) const {
        const float coat = kDielectric + (1 - kDielectric) * geometry.weight;
        return ((1 - mMetallic) * coat + mMetallic * geometry.weight) * geometry.facets;
    }

    vec3 mBaseColor;
    float mMetallic, mRoughness, mAlpha;
};

} // namespace

std::unique_ptr<Brdf> makeGltf(MaterialParameters& parameters) {
    const vec3 baseColor = parameters.color("base_color", vec3(0.8f), {0, 1});
    const float metallic = parameters.number("metallic", 0, {0, 1});
    const float roughness = parameters.number("roughness", 0.5f, {0, 1});
    return std::make_unique<Gltf>(baseColor, metallic, roughness);
}

} // namespace relume
