#include "precompute/brdf/models.h"

#include <cmath>
#include <fmt/core.h>

namespace relume {

namespace {

class Phong final : public Brdf {
  public:
    Phong(vec3 diffuse, vec3 specular, float exponent)
        : mDiffuse(diffuse), mSpecular(specular), mExponent(exponent) {}

    vec3 evaluate(vec3 incoming, vec3 outgoing) const override {
        const float cosine = incoming.z * outgoing.z - (incoming.x * outgoing.x + incoming.y * outgoing.y);
        if (cosine <= 0) return mDiffuse / kPi;
        const float lobe = std::pow(cosine, mExponent) * (mExponent + 2) / (2 * kPi);
        return mDiffuse / kPi + mSpecular * lobe;
    }

    vec3 evaluateBase(vec3, vec3) const override { return mDiffuse / kPi; }

    nlohmann::json describe() const override {
        return {{"model", "phong"},
                {"kd", colorToJson(mDiffuse)},
                {"ks", colorToJson(mSpecular)},
                {"exponent", numberToJson(mExponent)}};
    }

  private:
    vec3 mDiffuse, mSpecular;
    float mExponent;
};

} // namespace

std::unique_ptr<Brdf> makePhong(MaterialParameters& parameters) {
    const vec3 diffuse = parameters.color("kd", vec3(0.4f), {0, 1});
    const vec3 specular = parameters.color("ks", vec3(0.3f), {0, 1});
    // The slack is for decimals that add to one but for rounding.
    if (glm::any(glm::greaterThan(diffuse + specular, vec3(1.00001f))))
        parameters.noteFault(fmt::format("\"kd\" + \"ks\" must be at most 1 per channel, but is {} + {}",
                                         colorToJson(diffuse).dump(), colorToJson(specular).dump()));
    const float exponent = parameters.number("exponent", 30, {0, 1e5f});
    return std::make_unique<Phong>(diffuse, specular, exponent);
}

} // namespace relume
