// The BRDF model of glTF's material extensions: closed forms, limits, and the models that they equal.
#include "precompute/brdf/brdf.h"

#include <cmath>
#include <doctest/doctest.h>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

using namespace relume;

namespace {

const vec3 kAlongNormal(0, 0, 1);

vec3 directionAtAngles(float theta, float phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// The model with these parameters, JSON without braces.
std::unique_ptr<Brdf> gltf(const std::string& parameters) {
    return makeBrdf(R"({"model": "gltf", )" + parameters + "}");
}

std::vector<vec3> someDirections() {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<vec3> directions = {kAlongNormal, directionAtAngles(1.57f, 0)};
    for (int i = 0; i < 40; i++)
        directions.push_back(directionAtAngles(std::acos(1 - uniform(random)), 2 * kPi * uniform(random)));
    return directions;
}

// The largest difference of two BRDFs, as a share of their values.
float largestDifference(const Brdf& first, const Brdf& second) {
    float largest = 0;
    for (const vec3& a : someDirections())
        for (const vec3& b : someDirections()) {
            const vec3 one = first.evaluate(a, b), other = second.evaluate(a, b);
            largest = std::max(largest, glm::length(one - other) / (1e-6f + glm::length(one)));
        }
    return largest;
}

// ∫ f cosθi dωi of the first channel, by the midpoint rule, dense at the horizon.
double albedoTowards(const Brdf& brdf, vec3 outgoing) {
    constexpr int kSteps = 300;
    double sum = 0;
    for (int i = 0; i < kSteps; i++)
        for (int j = 0; j < kSteps; j++) {
            const float place = (float(i) + 0.5f) / kSteps, z = place * place, sine = std::sqrt(1 - z * z);
            const float phi = 2 * kPi * (float(j) + 0.5f) / kSteps;
            const vec3 incoming(sine * std::cos(phi), sine * std::sin(phi), z);
            sum += double(brdf.evaluate(incoming, outgoing).x * z * 2 * place);
        }
    return sum * 2 * double(kPi) / (kSteps * kSteps);
}

} // namespace

TEST_CASE("brdf glTF: extensions that do nothing change nothing") {
    const std::string plain = R"("base_color": [0.9, 0.5, 0.1], "metallic": 0.3, "roughness": 0.4)";
    for (const char* neutral :
         {R"("ior": 1.5)", R"("specular": 1, "specular_color": 1)",
          R"("clearcoat": 0, "clearcoat_roughness": 0.5)", R"("sheen_color": 0, "sheen_roughness": 0.5)",
          R"("anisotropy": 0, "anisotropy_rotation": 40)"}) {
        CAPTURE(neutral);
        const auto brdf = gltf(plain + ", " + neutral);
        CHECK(largestDifference(*gltf(plain), *brdf) < 1e-5f);
        CHECK(brdf->describe() == gltf(plain)->describe());
        CHECK(brdf->isIsotropic());
    }
    for (const char* visible : {R"("ior": 1.6)", R"("specular": 0.9)", R"("specular_color": 1.5)",
                                R"("clearcoat": 0.1)", R"("sheen_color": 0.1)", R"("anisotropy": 0.3)"}) {
        CAPTURE(visible);
        CHECK(largestDifference(*gltf(plain), *gltf(plain + ", " + visible)) > 1e-3f);
    }
}

TEST_CASE("brdf glTF: index of refraction and specular give the reflectance at normal incidence") {
    // Base c (1 - max F0), interface F0 / (4 α²), both over π: α = .25.
    const auto atNormal = [](const std::string& parameters) {
        return gltf(R"("base_color": 0.5, "roughness": 0.5, )" + parameters)
                   ->evaluate(kAlongNormal, kAlongNormal) *
               kPi;
    };
    const auto expected = [](double f0, double largest) { return 0.5 * (1 - largest) + f0 / (4 * 0.0625); };
    CHECK(atNormal(R"("ior": 2)").x == doctest::Approx(expected(1 / 9.0, 1 / 9.0)).epsilon(1e-5));
    CHECK(atNormal(R"("ior": 1)").x == doctest::Approx(0.5).epsilon(1e-5));
    CHECK(atNormal(R"("ior": 0)").x == doctest::Approx(expected(1, 1)).epsilon(1e-5));
    CHECK(atNormal(R"("specular": 0)").x == doctest::Approx(0.5).epsilon(1e-5));
    const vec3 colored = atNormal(R"("ior": 2, "specular": 0.5, "specular_color": [0, 1, 100])");
    CHECK(colored.x == doctest::Approx(expected(0, 0.5)).epsilon(1e-5));
    CHECK(colored.y == doctest::Approx(expected(0.5 / 9, 0.5)).epsilon(1e-5));
    CHECK(colored.z == doctest::Approx(expected(0.5, 0.5)).epsilon(1e-5)); // F0 is held to 1, times .5
    // Metal has no dielectric's interface.
    const std::string metal = R"("metallic": 1, "base_color": [0.9, 0.6, 0.3])";
    CHECK(largestDifference(*gltf(metal), *gltf(metal + R"(, "ior": 3, "specular": 0.2)")) < 1e-5f);
    // Without an interface, a Lambertian surface is left.
    CHECK(largestDifference(*gltf(R"("base_color": 0.7, "specular": 0)"),
                            *makeBrdf(R"({"model": "diffuse", "albedo": 0.7})")) < 1e-5f);
}

TEST_CASE(
    "brdf glTF: an interface of index 1.5 reflects 1 at the horizon whatever its color, times specular") {
    // A surface of polished black: the mirror direction at 89.9 degrees.
    const auto peak = [](const std::string& parameters) {
        return gltf(R"("base_color": 0, "roughness": 0.2, )" + parameters)
            ->evaluate(directionAtAngles(1.569f, 0), directionAtAngles(1.569f, kPi));
    };
    const vec3 white = peak(R"("specular": 1)"), red = peak(R"("specular_color": [1, 0, 0])");
    CHECK(red.y == doctest::Approx(white.y).epsilon(0.01));
    CHECK(peak(R"("specular": 0.25)").x == doctest::Approx(white.x / 4).epsilon(1e-4));
}

TEST_CASE(
    "brdf glTF: a clear coat at normal incidence adds its facets and takes its share of what is below") {
    const std::string below = R"("base_color": [0.8, 0.4, 0.2], "metallic": 0.5, "roughness": 0.6)";
    const vec3 plain = gltf(below)->evaluate(kAlongNormal, kAlongNormal);
    const auto brdf = gltf(below + R"(, "clearcoat": 0.5, "clearcoat_roughness": 0.5)");
    const vec3 coated = brdf->evaluate(kAlongNormal, kAlongNormal);
    const float peak = 0.5f * 0.04f / (4 * kPi * 0.0625f);
    for (int c = 0; c < 3; c++)
        CHECK(coated[c] == doctest::Approx(plain[c] * (1 - 0.5f * 0.04f) + peak).epsilon(1e-5));
    CHECK(brdf->evaluateBase(kAlongNormal, kAlongNormal).x ==
          doctest::Approx(gltf(below)->evaluateBase(kAlongNormal, kAlongNormal).x * 0.98f).epsilon(1e-5));
    // Over black that reflects nothing, it is a dielectric's interface alone.
    CHECK(largestDifference(
              *gltf(R"("base_color": 0, "specular": 0, "clearcoat": 1, "clearcoat_roughness": 0.3)"),
              *gltf(R"("base_color": 0, "roughness": 0.3)")) < 1e-5f);
}

TEST_CASE("brdf glTF: sheen has the specification's distribution and visibility, and scales what is below") {
    const std::string only = R"("base_color": 0, "specular": 0, "sheen_roughness": 1, "sheen_color": )";
    // Both directions at 60 degrees, side by side: there the fit is that of l(1/2), and α is 1.
    const vec3 w = directionAtAngles(kPi / 3, 0);
    const double l = 21.5473 / (1 + 3.82987 * std::pow(0.5, 0.19823)) - 1.97760 * 0.5 - 4.32054;
    const double value = 3 * std::sqrt(0.75) / (2 * double(kPi)) / (1 + 2 * std::exp(l));
    const vec3 sheen = gltf(only + "[1, 0.5, 0]")->evaluate(w, w);
    CHECK(sheen.x == doctest::Approx(value).epsilon(1e-4));
    CHECK(sheen.y == doctest::Approx(value / 2).epsilon(1e-4));
    CHECK(sheen.z == 0);
    // A Lambertian base of albedo 1 has 1 - E left, with E of the direction in which the sheen reflects more.
    // Narrow sheens, which are held to what they receive, hide a little more than they reflect.
    for (const float roughness : {0.1f, 0.4f, 1.0f})
        for (const float z : {0.7f, 0.2f, 0.05f, 0.01f}) {
            CAPTURE(roughness);
            CAPTURE(z);
            const std::string cloth = fmt::format(
                R"("specular": 0, "sheen_color": [1, 0.5, 0], "sheen_roughness": {}, "base_color": )",
                roughness);
            const vec3 out = directionAtAngles(std::acos(z), 1);
            const double reflected = albedoTowards(*gltf(cloth + "0"), out);
            const float left = gltf(cloth + "1")->evaluateBase(kAlongNormal, out).z * kPi;
            CHECK(reflected <= 1.001);
            CHECK(left <= 1.001 - reflected);
            if (roughness > 0.3f) CHECK(left == doctest::Approx(1 - reflected).epsilon(2e-3));
            CHECK(left == gltf(cloth + "1")->evaluateBase(out, kAlongNormal).z * kPi);
        }
}

TEST_CASE("brdf glTF: an anisotropic metal is the conductor of two widths, turned") {
    // α = .25 along the brush's normal, mix(.25, 1, .36) = .52 along the brush.
    const std::string metal =
        R"("base_color": [0.9, 0.6, 0.3], "metallic": 1, "roughness": 0.5, "anisotropy": 0.6)";
    const auto conductor = [](const char* u, const char* v) {
        return makeBrdf(fmt::format(
            R"({{"model": "ggx", "f0": [0.9, 0.6, 0.3], "roughness_u": {}, "roughness_v": {}}})", u, v));
    };
    CHECK(largestDifference(*gltf(metal), *conductor("0.52", "0.25")) < 1e-4f);
    CHECK(largestDifference(*gltf(metal + R"(, "anisotropy_rotation": 90)"), *conductor("0.25", "0.52")) <
          1e-4f);
    const auto turned = gltf(metal + R"(, "anisotropy_rotation": 30)");
    const float angle = glm::radians(30.0f);
    CHECK(turned->evaluate(directionAtAngles(0.5f, 0.2f + angle), directionAtAngles(0.9f, 2 + angle)).x ==
          doctest::Approx(gltf(metal)->evaluate(directionAtAngles(0.5f, 0.2f), directionAtAngles(0.9f, 2)).x)
              .epsilon(1e-4));
    CHECK_FALSE(turned->isIsotropic());
    CHECK(turned->describe()["anisotropy_rotation"] == 30);
}
