// Tests every BRDF model against closed forms, its energy and reciprocity; and materials from hostile text.
#include "engine/base/error.h"
#include "precompute/brdf/brdf.h"
#include "precompute/brdf/model_list.h"
#include "tests/support/capture_binding.h"
#include "tests/support/failure.h"

#include <array>
#include <cmath>
#include <doctest/doctest.h>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

using namespace relume;
using namespace relume::test;

namespace {

const vec3 kNormal(0, 0, 1);

vec3 direction(float theta, float phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

std::vector<std::string> materials() {
    std::vector<std::string> all;
    for (const MaterialPreset& preset : materialPresets()) all.push_back(preset.name);
    all.push_back(R"({"model": "plastic", "diffuse": 1, "f0": [0, 0.3, 1], "roughness": 0.5})");
    all.push_back(R"({"model": "oren-nayar", "albedo": [1, 0.3, 0], "sigma": 90})");
    all.push_back(R"({"model": "phong", "kd": [0.2, 0, 1], "ks": [0.7, 1, 0], "exponent": 0})");
    all.push_back(R"({"model": "phong", "kd": 0, "ks": 1, "exponent": 100000})");
    all.push_back(
        R"({"model": "cook-torrance", "diffuse": [0, 0.5, 1], "f0": [0, 0.5, 1], "roughness": 0.02})");
    all.push_back(R"({"model": "cook-torrance", "diffuse": 1, "f0": [0, 0.5, 1], "roughness": 1})");
    all.push_back(R"({"model": "ggx", "f0": [0, 0.5, 1], "roughness_u": 0.02, "roughness_v": 1})");
    all.push_back(R"({"model": "gltf", "base_color": [0, 0.5, 1], "metallic": 0.5, "roughness": 0})");
    all.push_back(R"({"model": "gltf", "base_color": [0, 0.5, 1], "metallic": 1, "roughness": 0.6})");
    for (const char* extensions :
         {R"("ior": 0, "specular": 0.5, "specular_color": [0, 1, 1000])",
          R"("metallic": 0.5, "sheen_color": [1, 0.5, 0], "sheen_roughness": 0)",
          R"("sheen_color": [0, 0.5, 1], "sheen_roughness": 0.7, "clearcoat": 1, "clearcoat_roughness": 0)",
          R"("metallic": 0.7, "anisotropy": 1, "anisotropy_rotation": 30, "clearcoat": 0.5)"})
        all.push_back(fmt::format(R"({{"model": "gltf", "base_color": [0, 0.5, 1], {}}})", extensions));
    all.push_back(R"({"model": "plastic", "diffuse": [1, 0.5, 0], "index": 2.5, "roughness": 1})");
    all.push_back(R"({"model": "ashikhmin-shirley", "kd": 1, "ks": [0, 0.2, 1], "nu": 0, "nv": 50})");
    return all;
}

// The message of the UsageError that the material causes; fails the test if it causes none.
std::string usageError(const std::string& material) {
    try {
        makeBrdf(material);
    } catch (const UsageError& error) {
        return error.what();
    }
    FAIL("accepted: " << material);
    return {};
}

} // namespace

TEST_CASE("brdf: diffuse is albedo over pi") {
    const auto brdf = makeBrdf(R"({"model": "diffuse", "albedo": [0.2, 0.4, 0.6]})");
    const vec3 value = brdf->evaluate(direction(1.0f, 2.0f), direction(0.3f, 1.0f));
    CHECK(glm::length(value * kPi - vec3(0.2f, 0.4f, 0.6f)) < 1e-6f);
}

TEST_CASE("brdf: Ashikhmin-Shirley at normal incidence has its closed form") {
    const auto brdf = makeBrdf("ashikhmin-shirley");
    const float transmitted = 1 - 1.0f / 32;
    const float diffuse = 28 * 0.5f * 0.25f / (23 * kPi) * transmitted * transmitted;
    const float specular = std::sqrt(11.0f * 101.0f) / (8 * kPi) * 0.75f;
    CHECK(brdf->evaluate(kNormal, kNormal).x == doctest::Approx(diffuse + specular).epsilon(1e-5));
}

TEST_CASE("brdf: Ashikhmin-Shirley is wide along s (nu 10), narrow along t (nv 100)") {
    const auto brdf = makeBrdf("ashikhmin-shirley");
    // The half vector tilts by 0.2 along each axis: specular lobes in the ratio cos^10 : cos^100.
    const vec3 alongS = brdf->evaluate(direction(0.4f, 0), kNormal);
    const vec3 alongT = brdf->evaluate(direction(0.4f, kPi / 2), kNormal);
    const auto base = makeBrdf(R"({"model": "ashikhmin-shirley", "kd": 0})");
    const float ratio =
        base->evaluate(direction(0.4f, 0), kNormal).x / base->evaluate(direction(0.4f, kPi / 2), kNormal).x;
    CHECK(alongS.x > 2 * alongT.x);
    CHECK(ratio == doctest::Approx(std::pow(std::cos(0.2), 10 - 100)).epsilon(1e-4));
}

TEST_CASE("brdf: a Lafortune lobe at the mirror direction has its closed form") {
    const auto brdf = makeBrdf(
        R"({"model": "lafortune", "diffuse": 0.1, "lobes": [{"cx": -0.9, "cy": -0.8, "cz": 0.7, "n": 5}]})");
    const float sine = std::sin(0.7f), cosine = std::cos(0.7f);
    const float alongX = std::pow(0.9f * sine * sine + 0.7f * cosine * cosine, 5.0f);
    const float alongY = std::pow(0.8f * sine * sine + 0.7f * cosine * cosine, 5.0f);
    CHECK(brdf->evaluate(direction(0.7f, 0), direction(0.7f, kPi)).x ==
          doctest::Approx(0.1f / kPi + alongX).epsilon(1e-4));
    CHECK(brdf->evaluate(direction(0.7f, kPi / 2), direction(0.7f, -kPi / 2)).x ==
          doctest::Approx(0.1f / kPi + alongY).epsilon(1e-4));
}

TEST_CASE("brdf: plastic at normal incidence has its closed form") {
    const auto brdf = makeBrdf(R"({"model": "plastic", "diffuse": 0.5, "index": 1.5, "roughness": 0.3})");
    const float reflectance = 0.04f; // (0.5 / 2.5)²
    const float base = 0.5f * (1 - reflectance) * (1 - reflectance) / kPi;
    const float coat = reflectance / (4 * kPi * 0.09f);
    CHECK(brdf->evaluate(kNormal, kNormal).x == doctest::Approx(base + coat).epsilon(1e-5));
}

TEST_CASE("brdf: the other models at normal incidence have their closed forms") {
    const auto atNormal = [](const char* material) {
        return makeBrdf(material)->evaluate(kNormal, kNormal).x;
    };
    // A / π with r = .45 s / (s + .09) / (1 - .5 s / (s + .33)), s the squared radians of 30 degrees
    const double s = std::pow(kPi / 6, 2), r = 0.45 * s / (s + 0.09) / (1 - 0.5 * s / (s + 0.33));
    CHECK(atNormal(R"({"model": "oren-nayar", "albedo": 0.6, "sigma": 30})") ==
          doctest::Approx(0.6 / (double(kPi) + r * (double(kPi) / 2 - 2.0 / 3))).epsilon(1e-5));
    CHECK(atNormal(R"({"model": "phong", "kd": 0.3, "ks": 0.5, "exponent": 18})") ==
          doctest::Approx((0.3 + 0.5 * 10) / double(kPi)).epsilon(1e-5));
    CHECK(atNormal(R"({"model": "cook-torrance", "diffuse": 0, "f0": 0.5, "roughness": 0.2})") ==
          doctest::Approx(0.5 / (4 * double(kPi) * 0.04)).epsilon(1e-5));
    CHECK(atNormal(R"({"model": "ggx", "f0": 0.8, "roughness_u": 0.1, "roughness_v": 0.4})") ==
          doctest::Approx(0.8 / (4 * double(kPi) * 0.04)).epsilon(1e-5));
    CHECK(atNormal(R"({"model": "gltf", "base_color": 0.5, "roughness": 0.5})") ==
          doctest::Approx((0.48 + 0.04 / (4 * 0.0625)) / double(kPi)).epsilon(1e-5));
}

TEST_CASE("brdf: brushed steel is wide along s") {
    const auto steel = makeBrdf("brushed-steel");
    CHECK(steel->evaluate(direction(0.6f, 0), kNormal).x >
          5 * steel->evaluate(direction(0.6f, kPi / 2), kNormal).x);
}

TEST_CASE("brdf: a turn about the normal changes those alone that are not isotropic") {
    for (const std::string& material : materials()) {
        CAPTURE(material);
        const auto brdf = makeBrdf(material);
        float worst = 0;
        // Near the mirror direction, where the narrowest lobes are.
        for (const float tilt : {0.01f, 0.05f, 0.2f})
            for (const float turn : {0.4f, 1.1f, 1.6f}) {
                const auto reflected = [&](float azimuth) {
                    const vec3 half =
                        glm::normalize(vec3(tilt * std::cos(azimuth), tilt * std::sin(azimuth), 1));
                    const vec3 out = direction(0.5f, azimuth + 2);
                    return brdf->evaluate(2 * glm::dot(half, out) * half - out, out);
                };
                const vec3 first = reflected(0.3f), other = reflected(0.3f + turn);
                worst = std::max(worst, glm::length(first - other) / glm::length(first));
            }
        CHECK((worst < 1e-3f) == brdf->isIsotropic());
    }
    CHECK_FALSE(makeBrdf(R"({"model": "ashikhmin-shirley", "nu": 500, "nv": 5000})")->isIsotropic());
    CHECK(makeBrdf(R"({"model": "ashikhmin-shirley", "nu": 50, "nv": 50})")->isIsotropic());
}

TEST_CASE("brdf: every material is reciprocal, finite and never negative, down to the horizon") {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<vec3> directions = {kNormal,        direction(1.5707f, 0), direction(1.5707f, kPi),
                                    {1, 0, 1e-30f}, {-1, 0, 1e-30f},       {0, 1, 1e-8f}};
    for (int i = 0; i < 100; i++)
        directions.push_back(direction(std::acos(1 - uniform(random)), 2 * kPi * uniform(random)));
    for (const std::string& material : materials()) {
        CAPTURE(material);
        const auto brdf = makeBrdf(material);
        CHECK(brdf->isReciprocal());
        for (const vec3& a : directions)
            for (const vec3& b : directions) {
                const vec3 there = brdf->evaluate(a, b), back = brdf->evaluate(b, a);
                for (int c = 0; c < 3; c++) {
                    REQUIRE(std::isfinite(there[c]));
                    REQUIRE(there[c] >= 0);
                    REQUIRE(brdf->evaluateBase(a, b)[c] >= 0);
                    REQUIRE(brdf->evaluateBase(a, b)[c] <= there[c]);
                    REQUIRE(std::abs(there[c] - back[c]) <= 1e-5f * there[c]);
                }
            }
    }
}

TEST_CASE("brdf: the base color's part is at most all, and alone scales with the base color") {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(0, 1);
    // Material, parameter of the base color, the same with half of it.
    const std::vector<std::array<std::string, 2>> pairs = {
        {R"({"model": "diffuse", "albedo": [0.8, 0.4, 0.2]})",
         R"({"model": "diffuse", "albedo": [0.4, 0.2, 0.1]})"},
        {R"({"model": "oren-nayar", "albedo": 0.8})", R"({"model": "oren-nayar", "albedo": 0.4})"},
        {R"({"model": "phong", "kd": 0.6})", R"({"model": "phong", "kd": 0.3})"},
        {R"({"model": "ashikhmin-shirley", "kd": 0.6})", R"({"model": "ashikhmin-shirley", "kd": 0.3})"},
        {R"({"model": "cook-torrance", "diffuse": 0.6})", R"({"model": "cook-torrance", "diffuse": 0.3})"},
        {R"({"model": "plastic", "diffuse": 0.6})", R"({"model": "plastic", "diffuse": 0.3})"},
        {R"({"model": "gltf", "base_color": 0.6})", R"({"model": "gltf", "base_color": 0.3})"},
        {R"({"model": "gltf", "base_color": 0.6, "metallic": 1})",
         R"({"model": "gltf", "base_color": 0.3, "metallic": 1})"},
        {R"({"model": "gltf", "base_color": 0.6, "metallic": 0.4})",
         R"({"model": "gltf", "base_color": 0.3, "metallic": 0.4})"},
        {R"({"model": "gltf", "base_color": 0.6, "metallic": 0.4, "ior": 1.8, "specular_color": [0, 1, 2],
             "anisotropy": 0.5, "sheen_color": [0.5, 0.2, 0], "sheen_roughness": 0.6, "clearcoat": 0.8})",
         R"({"model": "gltf", "base_color": 0.3, "metallic": 0.4, "ior": 1.8, "specular_color": [0, 1, 2],
             "anisotropy": 0.5, "sheen_color": [0.5, 0.2, 0], "sheen_roughness": 0.6, "clearcoat": 0.8})"},
        {R"({"model": "lafortune", "diffuse": 0.6, "lobes": [{"cx": -1, "cy": -1, "cz": 0.9, "n": 5}]})",
         R"({"model": "lafortune", "diffuse": 0.3, "lobes": [{"cx": -1, "cy": -1, "cz": 0.9, "n": 5}]})"}};
    for (int i = 0; i < 200; i++) {
        const vec3 a = direction(std::acos(1 - uniform(random)), 2 * kPi * uniform(random));
        const vec3 b = direction(std::acos(1 - uniform(random)), 2 * kPi * uniform(random));
        for (const auto& [material, halved] : pairs) {
            CAPTURE_BINDING(material);
            const auto whole = makeBrdf(material), half = makeBrdf(halved);
            const vec3 base = whole->evaluateBase(a, b), rest = whole->evaluate(a, b) - base;
            const vec3 baseOfHalf = half->evaluateBase(a, b), restOfHalf = half->evaluate(a, b) - baseOfHalf;
            for (int c = 0; c < 3; c++) {
                REQUIRE(baseOfHalf[c] == doctest::Approx(base[c] / 2).epsilon(1e-5));
                REQUIRE(std::abs(restOfHalf[c] - rest[c]) <= 1e-6f * (1 + base[c] + rest[c]));
                REQUIRE(base[c] > 0);
            }
        }
    }
    CHECK(makeBrdf("gold")->evaluateBase(kNormal, kNormal) == vec3(0));
}

TEST_CASE("brdf: a description makes the same BRDF") {
    const vec3 a = direction(0.5f, 0.3f), b = direction(0.6f, 3.0f);
    for (const std::string& material : materials()) {
        CAPTURE(material);
        const auto brdf = makeBrdf(material);
        const auto again = makeBrdf(brdf->describe().dump());
        CHECK(again->describe() == brdf->describe());
        CHECK(again->evaluate(a, b) == brdf->evaluate(a, b));
    }
    CHECK(makeBrdf("ashikhmin-shirley")->describe().dump() ==
          R"({"kd":[0.5,0.5,0.5],"ks":[0.75,0.75,0.75],"model":"ashikhmin-shirley","nu":10,"nv":100})");
}

TEST_CASE("brdf: absent parameters take the model's defaults") {
    const auto brdf = makeBrdf(R"( {"model": "ashikhmin-shirley", "nu": 20})");
    CHECK(brdf->describe()["nu"] == 20);
    CHECK(brdf->describe()["nv"] == 100);
    CHECK(makeBrdf("diffuse")->describe()["albedo"] == nlohmann::json({0.5, 0.5, 0.5}));
    CHECK(makeBrdf("plastic")->describe()["model"] == "plastic");
}

TEST_CASE("brdf: every model lists its parameters") {
    for (const MaterialModel& model : materialModels()) {
        CHECK_FALSE(model.parameters.empty());
        for (const MaterialParameter& parameter : model.parameters) CHECK_FALSE(parameter.values.empty());
    }
    const MaterialParameter albedo = materialModels().front().parameters.front();
    CHECK(albedo.name == "albedo");
    CHECK(albedo.values == "number from 0 to 1, or [red, green, blue] of such");
    CHECK(albedo.fallback == "0.5");
}

TEST_CASE("brdf: unknown names lead to the nearest valid one") {
    CHECK(says(usageError("red-plastik"), "did you mean \"red-plastic\""));
    CHECK(says(usageError("Clay"), "did you mean \"clay\""));
    CHECK(says(usageError("lafortun"), "did you mean \"lafortune\""));
    CHECK(says(usageError(R"({"model": "plastics"})"), "did you mean \"plastic\""));
    CHECK(says(usageError(R"({"model": "plastic", "rougness": 0.1})"), "did you mean \"roughness\""));
}

TEST_CASE("brdf: all faults of a material are told at once, misspelt parameters first") {
    CHECK(usageError(R"({"model": "plastic", "f0": 7, "rougness": 0.1, "index": 9})") ==
          "material plastic has 4 faults:\n"
          "  unknown parameter \"rougness\"; did you mean \"roughness\"?\n"
          "  \"f0\" must be a number from 0 to 1, or [red, green, blue] of such, but is 7\n"
          "  \"index\" must be a number from 1 to 5, but is 9\n"
          "  give \"f0\" or \"index\", not both");
    CHECK(usageError(R"({"model": "lafortune", "lobes": [3, {"cx": 0, "cy": 0, "cz": 1, "m": 2}]})") ==
          "material lafortune has 3 faults:\n"
          "  lobes[1]: unknown parameter \"m\"; did you mean \"n\"?\n"
          "  lobes[0] must be a JSON object of parameters, but is 3\n"
          "  lobes[1]: \"n\" is missing; give a number from 0 to 10000, or [red, green, blue]");
    std::string many = R"({"model": "diffuse")";
    for (int i = 0; i < 30; i++) many += fmt::format(R"(, "albedo{}": 1)", i);
    const std::string error = usageError(many + "}");
    CHECK(says(error, "has 30 faults"));
    CHECK(error.ends_with("\n  and 10 more"));
}

TEST_CASE("brdf: wrong parameters are named with their range") {
    const std::string error = usageError(R"({"model": "plastic", "roughness": 2})");
    CHECK(says(error, "\"roughness\""));
    CHECK(says(error, "from 0.02 to 1"));
    CHECK(says(error, "is 2"));
    const std::string lobe = R"({"cx": -1, "cy": -1, "cz": 1})";
    CHECK(says(usageError(R"({"model": "lafortune", "lobes": [)" + lobe + "]}"), "\"n\" is missing"));
    for (const char* material :
         {"",
          " ",
          "{",
          "{}",
          "{\"model\": 5}",
          R"({"model": "diffuse", "albedo": -0.1})",
          R"({"model": "diffuse", "albedo": 1e999})",
          R"({"model": "diffuse", "albedo": NaN})",
          R"({"model": "diffuse", "albedo": [0.1, 0.2]})",
          R"({"model": "diffuse", "albedo": [0, 0, "x"]})",
          R"({"model": "diffuse", "albedo": null})",
          R"({"model": "ashikhmin-shirley", "nu": -1})",
          R"({"model": "ashikhmin-shirley", "nu": [1, 2, 3]})",
          R"({"model": "ashikhmin-shirley", "ks": 1.1})",
          R"({"model": "plastic", "f0": 0.04, "index": 1.5})",
          R"({"model": "phong", "kd": 0.6, "ks": [0, 0.5, 0]})",
          R"({"model": "oren-nayar", "sigma": 91})",
          R"({"model": "ggx", "roughness_u": 0})",
          R"({"model": "gltf", "metallic": 1.5})",
          R"({"model": "gltf", "clearcoat": 1.1})",
          R"({"model": "gltf", "sheen_color": [1, 1, 2]})",
          R"({"model": "gltf", "ior": -1})",
          R"({"model": "cook-torrance", "roughness": 1e308})",
          R"({"model": "lafortune"})",
          "lafortune",
          R"({"model": "lafortune", "lobes": 3})",
          R"({"model": "lafortune", "lobes": [3]})",
          R"({"model": "lafortune", "lobes": [{"cx": -9, "cy": 9, "cz": 9, "n": 9999}]})"})
        usageError(material);
}

TEST_CASE("brdf: hostile text ends in an error, not in a crash") {
    usageError(std::string(1 << 17, ' ') + "{}");
    const std::string deep = std::string(30000, '[') + std::string(30000, ']');
    CHECK(says(usageError(R"({"model": "diffuse", "albedo": )" + deep + "}"), "nested"));
    usageError(std::string(1 << 20, 'x'));
    const std::string valid = makeBrdf("clay")->describe().dump();
    for (size_t length = 0; length < valid.size(); length++) usageError(valid.substr(0, length));
    for (size_t bit = 0; bit < 8 * valid.size(); bit += 3) {
        std::string flipped = valid;
        flipped[bit / 8] = char(flipped[bit / 8] ^ (1 << (bit % 8)));
        try {
            makeBrdf(flipped);
        } catch (const UsageError&) {
        }
    }
}
