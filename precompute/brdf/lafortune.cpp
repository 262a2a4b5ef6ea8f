#include "precompute/brdf/models.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <utility>

namespace relume {

namespace {

// Large enough for any fit in the literature, small enough to keep sums finite.
constexpr size_t kMaxLobes = 16;
constexpr float kMaxPeak = 1e6f;

struct Lobe {
    vec3 x, y, z, exponent; // each per color channel
};

class Lafortune final : public Brdf {
  public:
    Lafortune(vec3 diffuse, std::vector<Lobe> lobes) : mDiffuse(diffuse), mLobes(std::move(lobes)) {}

    vec3 evaluate(vec3 incoming, vec3 outgoing) const override {
        const vec3 product = incoming * outgoing;
        vec3 sum = mDiffuse / kPi;
        for (const Lobe& lobe : mLobes) {
            const vec3 base = lobe.x * product.x + lobe.y * product.y + lobe.z * product.z;
            for (int c = 0; c < 3; c++)
                if (base[c] > 0) sum[c] += std::pow(base[c], lobe.exponent[c]);
        }
        return sum;
    }

    vec3 evaluateBase(vec3, vec3) const override { return mDiffuse / kPi; }

    bool isIsotropic() const override {
        return std::ranges::all_of(mLobes, [](const Lobe& lobe) { return lobe.x == lobe.y; });
    }

    nlohmann::json describe() const override {
        nlohmann::json lobes = nlohmann::json::array();
        for (const Lobe& lobe : mLobes)
            lobes.push_back({{"cx", colorToJson(lobe.x)},
                             {"cy", colorToJson(lobe.y)},
                             {"cz", colorToJson(lobe.z)},
                             {"n", colorToJson(lobe.exponent)}});
        return {{"model", "lafortune"}, {"diffuse", colorToJson(mDiffuse)}, {"lobes", lobes}};
    }

  private:
    vec3 mDiffuse;
    std::vector<Lobe> mLobes;
};

Lobe readLobe(MaterialParameters& parameters) {
    Lobe lobe;
    lobe.x = parameters.requiredColor("cx", {-10, 10});
    lobe.y = parameters.requiredColor("cy", {-10, 10});
    lobe.z = parameters.requiredColor("cz", {-10, 10});
    lobe.exponent = parameters.requiredColor("n", {0, 1e4f});
    parameters.noteUnknownKeys();
    return lobe;
}

// Notes a fault if a lobe peaks too high. Its base is at most the largest of |cx|, |cy| and cz, since ωi.z
// ωo.z is never negative.
void checkPeak(const Lobe& lobe, MaterialParameters& parameters) {
    for (int c = 0; c < 3; c++) {
        const float base = std::max({std::abs(lobe.x[c]), std::abs(lobe.y[c]), lobe.z[c], 0.0f});
        if (!(std::pow(base, lobe.exponent[c]) <= kMaxPeak))
            parameters.noteFault(fmt::format("a lobe of base {} and exponent {} peaks above {} sr⁻¹; lower "
                                             "\"n\" or the coefficients",
                                             base, lobe.exponent[c], kMaxPeak));
    }
}

} // namespace

std::unique_ptr<Brdf> makeLafortune(MaterialParameters& parameters) {
    const vec3 diffuse = parameters.color("diffuse", vec3(0), {0, 1});
    std::vector<Lobe> lobes;
    for (MaterialParameters& item : parameters.list("lobes", kMaxLobes)) {
        lobes.push_back(readLobe(item));
        checkPeak(lobes.back(), item);
    }
    return std::make_unique<Lafortune>(diffuse, std::move(lobes));
}

} // namespace relume
