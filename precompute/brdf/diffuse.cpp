#include "precompute/brdf/models.h"

namespace relume {

namespace {

class Diffuse final : public Brdf {
  public:
    explicit Diffuse(vec3 albedo) : mAlbedo(albedo) {}

    vec3 evaluate(vec3, vec3) const override { return mAlbedo / kPi; }
    vec3 evaluateBase(vec3, vec3) const override { return mAlbedo / kPi; }

    nlohmann::json describe() const override {
        return {{"model", "diffuse"}, {"albedo", colorToJson(mAlbedo)}};
    }

  private:
    vec3 mAlbedo;
};

} // namespace

std::unique_ptr<Brdf> makeDiffuse(MaterialParameters& parameters) {
    return std::make_unique<Diffuse>(parameters.color("albedo", vec3(0.5f), {0, 1}));
}

} // namespace relume
