// Tests normals from normal maps, and metalness and roughness from glTF textures.
#include "engine/scene/surface_detail.h"

#include "engine/import/builtin_mesh.h"
#include "engine/import/metal_roughness_map.h"
#include "tests/support/mesh_samples.h"

#include <doctest/doctest.h>

using namespace relume;
using namespace relume::test;

namespace {

bool isNear(vec3 a, vec3 b) { return glm::distance(a, b) < 1e-5f; }

uint32_t texelOf(float roughness, float metallic) {
    return uint32_t(std::lround(255 * roughness)) << 8 | uint32_t(std::lround(255 * metallic)) << 16;
}

float weightOf(const Texture& weights, size_t texel, size_t node) {
    return float(weights.texels[texel] >> (8 * node) & 0xff) / 255;
}

} // namespace

TEST_CASE("normal map: x is right in the image, y up, whichever way it lies") {
    const float half = std::sqrt(0.5f);
    Mesh mesh = makeSquare();
    const vec3 normal(0, 0, 1), right(half, 0, half), up(0, half, half);
    for (const uvec3& corners : mesh.triangles) {
        CHECK(isNear(mappedNormal(normal, mesh, corners, normal), normal));
        CHECK(isNear(mappedNormal(normal, mesh, corners, {1, 0, 1}), right));
        CHECK(isNear(mappedNormal(normal, mesh, corners, {0, 1, 1}), up));
    }
    for (vec2& uv : mesh.uvs) uv.x = -uv.x; // mirrored: the image's right is -x
    for (const uvec3& corners : mesh.triangles) {
        CHECK(isNear(mappedNormal(normal, mesh, corners, {1, 0, 1}), {-half, 0, half}));
        CHECK(isNear(mappedNormal(normal, mesh, corners, {0, 1, 1}), up));
    }
    mesh = makeSquare();
    for (vec2& uv : mesh.uvs) uv = vec2(uv.y, -uv.x); // turned: the image's right is -y
    for (const uvec3& corners : mesh.triangles) {
        CHECK(isNear(mappedNormal(normal, mesh, corners, {1, 0, 1}), {0, -half, half}));
        CHECK(isNear(mappedNormal(normal, mesh, corners, {0, 1, 1}), right));
    }
    // An interpolated normal that leans stays the axis.
    const vec3 leaning = glm::normalize(vec3(0.3f, 0.1f, 1));
    CHECK(isNear(mappedNormal(leaning, mesh, mesh.triangles[0], {0, 0, 2}), leaning));
    for (vec2& uv : mesh.uvs) uv = vec2(0.5f);
    CHECK(mappedNormal(normal, mesh, mesh.triangles[0], {1, 0, 1}) == normal);
}

TEST_CASE("normal map: an image of even normals, scaled") {
    const Mesh mesh = makeSquare();
    SurfaceDetail detail;
    const vec3 normal(0, 0, 1);
    CHECK(detailedNormal(detail, normal, mesh, mesh.triangles[0], {0.5f, 0.5f}) == normal);
    detail.normalMap = Texture{1, 1, {0xffff80ff}}; // (1, 0, 1)
    const vec3 found = detailedNormal(detail, normal, mesh, mesh.triangles[0], {0.5f, 0.5f});
    CHECK(glm::distance(found, vec3(std::sqrt(0.5f), 0, std::sqrt(0.5f))) < 0.01f);
    detail.normalScale = 0.5f;
    const vec3 less = detailedNormal(detail, normal, mesh, mesh.triangles[0], {0.5f, 0.5f});
    CHECK(glm::distance(less, glm::normalize(vec3(0.5f, 0, 1))) < 0.01f);
}

TEST_CASE("metal and roughness: what is even needs no blend") {
    const Texture even{2, 1, {texelOf(0.5f, 1), texelOf(0.52f, 1)}};
    CHECK(!blendMetalRoughness(even, 1, 1));
    const Texture gray{2, 1, {texelOf(0.3f, 0), texelOf(0.9f, 1)}};
    CHECK(!blendMetalRoughness(gray, 0, 0.1f)); // factors make it smooth, and no metal
}

TEST_CASE("metal and roughness: nodes span the texture, weights give back its lobes") {
    Texture ramp{64, 1, {}};
    for (int i = 0; i < 64; i++) ramp.texels.push_back(texelOf(0.2f + 0.6f * float(i) / 63, 0));
    const auto map = blendMetalRoughness(ramp, 1, 1);
    REQUIRE(map);
    REQUIRE(map->nodes.size() == 4);
    CHECK(map->nodes.front().roughness == doctest::Approx(0.2).epsilon(0.1));
    CHECK(map->nodes.back().roughness == doctest::Approx(0.8).epsilon(0.05));
    for (size_t texel = 2; texel < 62; texel++) {
        float all = 0, inverse = 0;
        for (size_t node = 0; node < 4; node++) {
            const float weight = weightOf(map->weights, texel, node), roughness = map->nodes[node].roughness;
            all += weight;
            inverse += weight / (roughness * roughness);
        }
        CHECK(all == doctest::Approx(1).epsilon(0.01));
        const float wanted = 0.2f + 0.6f * float(texel) / 63;
        CHECK(inverse == doctest::Approx(1 / (wanted * wanted)).epsilon(0.05));
    }
}

TEST_CASE("metal and roughness: metal and paint have roughnesses of their own") {
    Texture texture{40, 1, {}};
    for (int i = 0; i < 20; i++) texture.texels.push_back(texelOf(0.3f + 0.01f * float(i), 1));
    for (int i = 0; i < 20; i++) texture.texels.push_back(texelOf(0.9f, 0));
    const auto map = blendMetalRoughness(texture, 1, 1);
    REQUIRE(map);
    REQUIRE(map->nodes.size() >= 3);
    CHECK(map->nodes[0].metallic == 0);
    CHECK(map->nodes[0].roughness == doctest::Approx(0.9).epsilon(0.01));
    for (size_t node = 1; node < map->nodes.size(); node++) {
        CHECK(map->nodes[node].metallic == 1);
        CHECK(map->nodes[node].roughness < 0.5f);
    }
    CHECK(weightOf(map->weights, 30, 0) == 1);
    CHECK(weightOf(map->weights, 0, 0) == 0);
    CHECK(weightOf(map->weights, 0, 1) > 0.9f);
}
