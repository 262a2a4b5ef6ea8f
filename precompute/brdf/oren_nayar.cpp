#include "engine/math/disk_map.h"
#include "precompute/brdf/models.h"

#include <algorithm>

namespace relume {

namespace {

class OrenNayar final : public Brdf {
  public:
    OrenNayar(vec3 albedo, float sigma) : mAlbedo(albedo), mSigma(sigma) {
        const float radians = sigma * kPi / 180, squared = radians * radians;
        mRatio = 0.45f * squared / (squared + 0.09f) / (1 - 0.5f * squared / (squared + 0.33f));
        mScale = 1 / (kPi * (1 + mRatio * (0.5f - 2 / (3 * kPi))));
    }

    vec3 evaluate(vec3 incoming, vec3 outgoing) const override {
        // Lift directions so that the quotient stays finite.
        const vec3 wi = liftAboveHorizon(incoming), wo = liftAboveHorizon(outgoing);
        const float alignment = wi.x * wo.x + wi.y * wo.y;
        const float scaled = alignment > 0 ? alignment / std::max(wi.z, wo.z) : alignment;
        return mAlbedo * (mScale * (1 + mRatio * scaled));
    }

    vec3 evaluateBase(vec3 incoming, vec3 outgoing) const override { return evaluate(incoming, outgoing); }

    nlohmann::json describe() const override {
        return {{"model", "oren-nayar"}, {"albedo", colorToJson(mAlbedo)}, {"sigma", numberToJson(mSigma)}};
    }

  private:
    vec3 mAlbedo;
    float mSigma;         // degrees
    float mRatio, mScale; // r and A / π
};

} // namespace

std::unique_ptr<Brdf> makeOrenNayar(MaterialParameters& parameters) {
    const vec3 albedo = parameters.color("albedo", vec3(0.5f), {0, 1});
    const float sigma = parameters.number("sigma", 20, {0, 90});
    return std::make_unique<OrenNayar>(albedo, sigma);
}

} // namespace relume
