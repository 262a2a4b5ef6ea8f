// Tests the energy of every BRDF preset and model, down to grazing angles.
#include "precompute/brdf/brdf.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <string>
#include <vector>

using namespace relume;

namespace {

// For quadrature: see "the quadrature finds known albedos".
constexpr float kTolerance = 1e-3f;

vec3 directionAtHeight(float z, float phi) {
    const float sine = std::sqrt(1 - z * z);
    return {sine * std::cos(phi), sine * std::sin(phi), z};
}

// ∫ f cosθi dωi by the midpoint rule over half vectors, dωi = 4 (h·ωo) dωh, dense about the normal, where the
// lobes of all models have their peaks.
vec3 albedo(const Brdf& brdf, vec3 outgoing) {
    const int rings = 240, sectors = 240;
    glm::dvec3 sum(0);
    for (int ring = 0; ring < rings; ring++) {
        const float place = (float(ring) + 0.5f) / rings;
        const float theta = place * place * kPi / 2, width = place * kPi / rings;
        for (int sector = 0; sector < sectors; sector++) {
            const vec3 half = directionAtHeight(std::cos(theta), 2 * kPi * (float(sector) + 0.5f) / sectors);
            const float cosine = glm::dot(half, outgoing);
            const vec3 incoming = glm::normalize(2 * cosine * half - outgoing);
            if (cosine <= 0 || incoming.z <= 0) continue;
            sum += glm::dvec3(brdf.evaluate(incoming, outgoing) *
                              (incoming.z * 4 * cosine * std::sin(theta) * width));
        }
    }
    return vec3(sum * (2 * double(kPi) / sectors));
}

// The largest over channels and outgoing directions.
float largestAlbedo(const Brdf& brdf) {
    float largest = 0;
    for (float z : {1.0f, 0.9f, 0.7f, 0.5f, 0.35f, 0.25f, 0.15f, 0.1f, 0.06f, 0.04f, 0.02f, 0.01f})
        for (float phi : {0.0f, 0.8f, kPi / 2}) {
            const vec3 reflected = albedo(brdf, directionAtHeight(z, phi));
            largest = std::max({largest, reflected.x, reflected.y, reflected.z});
        }
    return largest;
}

float largestAlbedo(const std::string& material) { return largestAlbedo(*makeBrdf(material)); }

} // namespace

TEST_CASE("brdf energy: the quadrature finds known albedos") {
    for (float z : {1.0f, 0.5f, 0.1f, 0.01f})
        CHECK(std::abs(albedo(*makeBrdf("white-diffuse"), directionAtHeight(z, 0.3f)).x - 0.8f) < kTolerance);
    // Narrow facets that reflect everything lose next to nothing at normal incidence.
    const auto mirror = makeBrdf(R"({"model": "ggx", "f0": 1, "roughness_u": 0.02, "roughness_v": 0.04})");
    CHECK(std::abs(albedo(*mirror, directionAtHeight(1, 0)).x - 1) < 2e-3f);
}

TEST_CASE("brdf energy: no preset reflects more than it receives") {
    for (const MaterialPreset& preset : materialPresets()) {
        CAPTURE(preset.name);
        const float largest = largestAlbedo(preset.name);
        CAPTURE(largest);
        CHECK(largest <= 1 + kTolerance);
    }
}

TEST_CASE("brdf energy: no model reflects more than it receives at its extremes") {
    for (const char* material :
         {R"({"model": "oren-nayar", "albedo": 1, "sigma": 90})",
          R"({"model": "oren-nayar", "albedo": 1, "sigma": 0})",
          R"({"model": "oren-nayar", "albedo": 1, "sigma": 25})",
          R"({"model": "phong", "kd": [0, 0.5, 1], "ks": [1, 0.5, 0], "exponent": 0})",
          R"({"model": "phong", "kd": [0, 0.5, 1], "ks": [1, 0.5, 0], "exponent": 20})",
          R"({"model": "phong", "kd": 0, "ks": 1, "exponent": 500})",
          R"({"model": "cook-torrance", "diffuse": 1, "f0": [0, 0.3, 1], "roughness": 0.05})",
          R"({"model": "cook-torrance", "diffuse": 1, "f0": [0, 0.04, 1], "roughness": 0.4})",
          R"({"model": "cook-torrance", "diffuse": 1, "f0": [0, 0.04, 1], "roughness": 1})",
          R"({"model": "ggx", "f0": 1, "roughness_u": 0.05, "roughness_v": 0.05})",
          R"({"model": "ggx", "f0": 1, "roughness_u": 0.1, "roughness_v": 1})",
          R"({"model": "ggx", "f0": 1, "roughness_u": 1, "roughness_v": 1})",
          R"({"model": "gltf", "base_color": 1, "roughness": 0})",
          R"({"model": "gltf", "base_color": 1, "roughness": 0.5})",
          R"({"model": "gltf", "base_color": 1, "roughness": 1})",
          R"({"model": "gltf", "base_color": 1, "roughness": 0.7, "metallic": 0.5})",
          R"({"model": "gltf", "base_color": 1, "roughness": 0.4, "metallic": 1})",
          R"({"model": "gltf", "base_color": 1, "roughness": 0.3, "ior": 0, "specular": 0.5})",
          R"({"model": "gltf", "base_color": 1, "roughness": 1, "ior": 2.5, "specular": 0.3})",
          R"({"model": "gltf", "base_color": 1, "roughness": 0.2, "specular_color": [0, 5, 100]})",
          R"({"model": "gltf", "base_color": 1, "roughness": 0.5, "clearcoat": 1})",
          R"({"model": "gltf", "base_color": 1, "metallic": 1, "roughness": 0.2, "clearcoat": 1,
              "clearcoat_roughness": 1})",
          R"({"model": "gltf", "base_color": 1, "specular": 0, "clearcoat": 1, "clearcoat_roughness": 0.6})",
          R"({"model": "gltf", "base_color": 1, "specular": 0, "sheen_color": [0, 0.5, 1]})",
          R"({"model": "gltf", "base_color": 1, "sheen_color": [0, 0.5, 1], "sheen_roughness": 0.3})",
          R"({"model": "gltf", "base_color": 1, "metallic": 1, "roughness": 0.3, "sheen_color": 1,
              "sheen_roughness": 1, "clearcoat": 1, "clearcoat_roughness": 0.3})",
          R"({"model": "gltf", "base_color": 1, "metallic": 1, "roughness": 0.3, "anisotropy": 0.8,
              "anisotropy_rotation": 20})",
          R"({"model": "plastic", "diffuse": 1, "f0": [0, 0.04, 1], "roughness": 0.1})",
          R"({"model": "plastic", "diffuse": 1, "f0": [0, 0.04, 1], "roughness": 1})",
          R"({"model": "ashikhmin-shirley", "kd": 1, "ks": [0, 0.2, 1], "nu": 0, "nv": 50})",
          R"({"model": "ashikhmin-shirley", "kd": 1, "ks": [0, 0.2, 1], "nu": 300, "nv": 300})"}) {
        CAPTURE(material);
        const float largest = largestAlbedo(std::string(material));
        CAPTURE(largest);
        CHECK(largest <= 1 + kTolerance);
    }
}
