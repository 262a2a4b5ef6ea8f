#include "engine/math/disk_map.h"
#include "precompute/brdf/microfacet.h"
#include "precompute/brdf/models.h"
#include "precompute/brdf/sheen.h"

namespace relume {

namespace {

constexpr float kIor = 1.5f;        // of a dielectric without KHR_materials_ior
constexpr float kCoatF0 = 0.04f;    // of that index
constexpr float kMostFactor = 1000; // of what the specifications leave unbounded

struct GltfParameters {
    vec3 baseColor;
    float metallic, roughness;
    float ior, specular;
    vec3 specularColor;
    float anisotropy, anisotropyRotation; // degrees, counter-clockwise from s
    vec3 sheenColor;
    float sheenRoughness;
    float clearcoat, clearcoatRoughness;
};

float largestChannel(vec3 color) { return std::max({color.x, color.y, color.z}); }

float facetWidth(float roughness) { return std::max(roughness * roughness, kMinAlpha); }

Ggx stretched(float alpha, float anisotropy) {
    return {glm::mix(alpha, 1.0f, anisotropy * anisotropy), alpha};
}

// Schlick's Fresnel term at normal incidence.
float normalReflectance(float ior) {
    const double ratio = (double(ior) - 1) / (double(ior) + 1);
    return float(ratio * ratio);
}

// The share of light that crosses an interface on the way in and out: (1 - F(cosθi)) (1 - F(cosθo)) /
// (1 - F(1)), which at normal incidence is the specification's 1 - F.
class Transmission {
  public:
    Transmission(float atNormal, float atHorizon)
        : mAtNormal(1 - atNormal), mSlope(atNormal < 1 ? (atHorizon - atNormal) / (1 - atNormal) : 0) {}

    float operator()(vec3 wi, vec3 wo) const {
        return mAtNormal * (1 - mSlope * schlickWeight(wi.z)) * (1 - mSlope * schlickWeight(wo.z));
    }

  private:
    float mAtNormal, mSlope;
};

class Gltf final : public Brdf {
  public:
    explicit Gltf(const GltfParameters& given)
        : mGiven(given),
          mAtNormal(given.specular * glm::min(normalReflectance(given.ior) * given.specularColor, vec3(1))),
          mIntoBase(largestChannel(mAtNormal), given.specular),
          mIntoCoat(given.clearcoat * kCoatF0, given.clearcoat),
          mFacets(stretched(facetWidth(given.roughness), given.anisotropy)),
          mBrush(std::cos(glm::radians(given.anisotropyRotation)),
                 std::sin(glm::radians(given.anisotropyRotation))),
          mSheen(given.sheenColor, given.sheenRoughness), mCoat{facetWidth(given.clearcoatRoughness),
                                                                facetWidth(given.clearcoatRoughness)} {}

    vec3 evaluate(vec3 incoming, vec3 outgoing) const override {
        const Geometry geometry(*this, incoming, outgoing);
        return base(geometry) + rest(geometry);
    }

    vec3 evaluateBase(vec3 incoming, vec3 outgoing) const override {
        return base(Geometry(*this, incoming, outgoing));
    }

    bool isIsotropic() const override { return mFacets.alphaU == mFacets.alphaV; }

    // Leaves out extensions that change nothing.
    nlohmann::json describe() const override {
        nlohmann::json json = {{"model", "gltf"},
                               {"base_color", colorToJson(mGiven.baseColor)},
                               {"metallic", numberToJson(mGiven.metallic)},
                               {"roughness", numberToJson(mGiven.roughness)}};
        if (mGiven.ior != kIor) json["ior"] = numberToJson(mGiven.ior);
        if (mGiven.specular != 1) json["specular"] = numberToJson(mGiven.specular);
        if (mGiven.specularColor != vec3(1)) json["specular_color"] = colorToJson(mGiven.specularColor);
        if (mGiven.anisotropy > 0) {
            json["anisotropy"] = numberToJson(mGiven.anisotropy);
            json["anisotropy_rotation"] = numberToJson(mGiven.anisotropyRotation);
        }
        if (mGiven.sheenColor != vec3(0)) {
            json["sheen_color"] = colorToJson(mGiven.sheenColor);
            json["sheen_roughness"] = numberToJson(mGiven.sheenRoughness);
        }
        if (mGiven.clearcoat > 0) {
            json["clearcoat"] = numberToJson(mGiven.clearcoat);
            json["clearcoat_roughness"] = numberToJson(mGiven.clearcoatRoughness);
        }
        return json;
    }

  private:
    // Terms of two directions that both parts use.
    struct Geometry {
        vec3 wi, wo, half; // lifted, so that neither the half vector nor a denominator can vanish
        float weight;      // (1 - h·ωo)⁵
        float facets;      // D V
        float underSheen, underCoat;

        Geometry(const Gltf& material, vec3 incoming, vec3 outgoing)
            : wi(liftAboveHorizon(incoming)), wo(liftAboveHorizon(outgoing)) {
            const HalfVector middle(wi, wo);
            half = middle.direction;
            weight = schlickWeight(middle.cosine);
            const auto turned = [&](vec3 w) { return material.alongBrush(w); };
            facets = material.mFacets.distribution(turned(half)) *
                     material.mFacets.visibility(turned(wi), turned(wo));
            underSheen = material.mSheen.scaleBelow(wi, wo);
            underCoat = material.mIntoCoat(wi, wo);
        }
    };

    // A direction in the frame whose s the brush's strokes follow.
    vec3 alongBrush(vec3 w) const {
        return {mBrush.x * w.x + mBrush.y * w.y, mBrush.x * w.y - mBrush.y * w.x, w.z};
    }

    // Linear in the base color: the diffuse base, and F0 of the metal in c (1 - w) + w.
    vec3 base(const Geometry& g) const {
        const float metallic = mGiven.metallic;
        return mGiven.baseColor *
               (g.underSheen * g.underCoat *
                ((1 - metallic) * mIntoBase(g.wi, g.wo) / kPi + metallic * (1 - g.weight) * g.facets));
    }

    // The interface of the dielectric, what a metal of any color reflects, sheen and coat.
    vec3 rest(const Geometry& g) const {
        const float metallic = mGiven.metallic;
        const vec3 interface = mAtNormal + (mGiven.specular - mAtNormal) * g.weight;
        const vec3 surface = ((1 - metallic) * interface + metallic * g.weight) * g.facets;
        return (surface * g.underSheen + mSheen.evaluate(g.wi, g.wo, g.half)) * g.underCoat + coat(g);
    }

    vec3 coat(const Geometry& g) const {
        if (mGiven.clearcoat == 0) return vec3(0);
        const float fresnel = kCoatF0 + (1 - kCoatF0) * g.weight;
        return vec3(mGiven.clearcoat * fresnel * mCoat.distribution(g.half) * mCoat.visibility(g.wi, g.wo));
    }

    GltfParameters mGiven;
    vec3 mAtNormal; // Fresnel term of the dielectric at normal incidence
    Transmission mIntoBase, mIntoCoat;
    Ggx mFacets;
    vec2 mBrush; // direction of the greater width
    Sheen mSheen;
    Ggx mCoat;
};

} // namespace

std::unique_ptr<Brdf> makeGltf(MaterialParameters& parameters) {
    GltfParameters given;
    given.baseColor = parameters.color("base_color", vec3(0.8f), {0, 1});
    given.metallic = parameters.number("metallic", 0, {0, 1});
    given.roughness = parameters.number("roughness", 0.5f, {0, 1});
    given.ior = parameters.number("ior", kIor, {0, kMostFactor});
    given.specular = parameters.number("specular", 1, {0, 1});
    given.specularColor = parameters.color("specular_color", vec3(1), {0, kMostFactor});
    given.anisotropy = parameters.number("anisotropy", 0, {0, 1});
    given.anisotropyRotation = parameters.number("anisotropy_rotation", 0, {-360, 360});
    given.sheenColor = parameters.color("sheen_color", vec3(0), {0, 1});
    given.sheenRoughness = parameters.number("sheen_roughness", 0, {0, 1});
    given.clearcoat = parameters.number("clearcoat", 0, {0, 1});
    given.clearcoatRoughness = parameters.number("clearcoat_roughness", 0, {0, 1});
    return std::make_unique<Gltf>(given);
}

} // namespace relume
