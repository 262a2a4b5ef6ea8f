// glTF's material extensions as parameters of the model, and the tangents that anisotropy follows.
#include "engine/base/error.h"
#include "engine/import/mesh_formats.h"
#include "precompute/brdf/brdf.h"
#include "tests/support/failure.h"
#include "tests/support/log_capture.h"
#include "tests/support/textured_glb.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace relume;
using namespace relume::test;

namespace {

using Json = nlohmann::json;

// The first square's part in a material of these members.
GltfPart decodeMaterial(const std::string& members) {
    TexturedGlb glb;
    glb.materials = "[{" + members + R"(},{"name":"other"}])";
    return decodeGlb(glb.bytes()).parts[0];
}

std::string materialFailure(const std::string& members) {
    return failureOf([&] { decodeMaterial(members); });
}

// Two squares whose tangents are X, with w of 1 and -1, in a brushed material; `node` as JSON.
std::vector<GltfPart> decodeBrushed(const std::string& material, const std::string& node = R"({"mesh":0})") {
    TexturedGlb glb;
    glb.primitives = R"([{"attributes":{"POSITION":0,"NORMAL":1,"TANGENT":5},"indices":3,"material":0},
        {"attributes":{"POSITION":0,"NORMAL":1,"TANGENT":5},"indices":4,"material":1}])";
    glb.materials = "[" + material + "," + material + "]";
    auto [text, buffer] = glb.content();
    Json json = Json::parse(text);
    json["nodes"] = Json::array({Json::parse(node)});
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", 12 * 16}});
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                 {"componentType", 5126},
                                 {"count", 12},
                                 {"type", "VEC4"}});
    for (int i = 0; i < 12; i++)
        for (const float value : {1.0f, 0.0f, 0.0f, i < 6 ? 1.0f : -1.0f}) put(buffer, value);
    json["buffers"][0]["byteLength"] = buffer.size();
    return decodeGlb(glbOf(json.dump(), buffer)).parts;
}

} // namespace

TEST_CASE("glTF extensions: factors become parameters of the model") {
    const LogCapture log;
    const GltfPart part = decodeMaterial(R"("name":"cloth","pbrMetallicRoughness":{"roughnessFactor":0.5},
        "extensions":{"KHR_materials_ior":{"ior":1.25},
        "KHR_materials_specular":{"specularFactor":0.5,"specularColorFactor":[0.25,2,3]},
        "KHR_materials_clearcoat":{"clearcoatFactor":0.75,"clearcoatRoughnessFactor":0.125},
        "KHR_materials_sheen":{"sheenColorFactor":[1,0.5,0.25],"sheenRoughnessFactor":0.375},
        "KHR_materials_anisotropy":{"anisotropyStrength":0.5,"anisotropyRotation":1.5707963267948966}})");
    CHECK(
        part.material ==
        R"({"name":"cloth","model":"gltf","base_color":[1.0,1.0,1.0],"metallic":1.0,"roughness":0.5,)"
        R"("ior":1.25,"specular":0.5,"specular_color":[0.25,2.0,3.0],"anisotropy":0.5,)"
        R"("anisotropy_rotation":90.0,"sheen_color":[1.0,0.5,0.25],"sheen_roughness":0.375,"clearcoat":0.75,)"
        R"("clearcoat_roughness":0.125})");
    CHECK_FALSE(makeBrdf(part.material)->isIsotropic());
    CHECK_FALSE(log.says("ignored"));
    // Absent factors keep the model's defaults, which are the specifications'.
    CHECK(!says(decodeMaterial(R"("extensions":{"KHR_materials_sheen":{},"KHR_materials_ior":{}})").material,
                "ior"));
}

TEST_CASE("glTF extensions: factors are clamped, textures and other extensions are told") {
    const LogCapture log;
    const GltfPart part = decodeMaterial(R"("extensions":{"KHR_materials_ior":{"ior":1e9},
        "KHR_materials_specular":{"specularFactor":-1,"specularColorFactor":[-1,1e9,0],"specularTexture":{"index":0},
        "specularColorTexture":{"index":77}},"KHR_materials_transmission":{"transmissionTexture":7},
        "KHR_materials_clearcoat":{"clearcoatFactor":7,"clearcoatNormalTexture":{"index":0}},
        "KHR_materials_anisotropy":{"anisotropyStrength":2,"anisotropyRotation":-7.853981633974483},
        "KHR_materials_sheen":{"sheenColorFactor":[2,-2,0.5]}})");
    const Json json = Json::parse(part.material);
    CHECK(json["ior"] == 1000);
    CHECK(json["specular"] == 0);
    CHECK(json["specular_color"] == Json({0, 1000, 0}));
    CHECK(json["clearcoat"] == 1);
    CHECK(json["anisotropy"] == 1);
    CHECK(json["anisotropy_rotation"].get<double>() == doctest::Approx(-90));
    CHECK(json["sheen_color"] == Json({1, 0, 0.5}));
    makeBrdf(part.material); // all are in range
    CHECK(log.says("clearcoatNormalTexture, specularColorTexture, specularTexture"));
    CHECK(log.says("KHR_materials_transmission"));
    CHECK_FALSE(log.says("KHR_materials_clearcoat"));
    CHECK_FALSE(log.says("transmissionTexture"));
}

TEST_CASE("glTF extensions: every material of a set has them") {
    const GltfPart part = decodeMaterial(R"("pbrMetallicRoughness":{"metallicRoughnessTexture":{"index":0}},
        "extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":0.5}})");
    const Json set = Json::parse(part.material)["set"];
    REQUIRE(set.size() == 4);
    for (const Json& material : set) CHECK(material["clearcoat"] == 0.5);
}

TEST_CASE("glTF extensions: some that lie") {
    const auto withExtension = [](const std::string& extension) {
        return materialFailure(R"("extensions":{)" + extension + "}");
    };
    CHECK(withExtension(R"("KHR_materials_ior":{"ior":1.5})") == "");
    CHECK(says(withExtension(R"("KHR_materials_ior":7)"), "materials[0]: \"KHR_materials_ior\""));
    CHECK(says(withExtension(R"("KHR_materials_ior":{"ior":"1"})"), "\"ior\""));
    CHECK(says(withExtension(R"("KHR_materials_sheen":{"sheenColorFactor":[1,1]})"), "3 numbers"));
    CHECK(says(withExtension(R"("KHR_materials_sheen":{"sheenColorFactor":1})"), "sheenColorFactor"));
    CHECK(says(withExtension(R"("KHR_materials_anisotropy":{"anisotropyRotation":null})"),
               "anisotropyRotation"));
    CHECK(says(materialFailure(R"("extensions":[])"), "extensions"));
}

TEST_CASE("glTF extensions: anisotropy turns counter-clockwise in a texture's own sense") {
    const auto brushed = [](double radians) {
        return fmt::format(
            R"({{"extensions":{{"KHR_materials_anisotropy":{{"anisotropyStrength":0.5,"anisotropyRotation":{}}}}}}})",
            radians);
    };
    // The model turns by 30 degrees: where the bitangent is on the other side, tangents are turned by -60
    // first.
    const std::vector<GltfPart> parts = decodeBrushed(brushed(double(kPi) / 6));
    REQUIRE(parts.size() == 2);
    for (const vec3& tangent : parts[0].mesh.tangents) CHECK(glm::distance(tangent, vec3(1, 0, 0)) < 1e-5f);
    const float sine = std::sqrt(0.75f);
    for (const vec3& tangent : parts[1].mesh.tangents)
        CHECK(glm::distance(tangent, vec3(0.5f, -sine, 0)) < 1e-5f);
    REQUIRE(parts[1].mesh.tangents.size() == 4);
    // A node that mirrors makes it the other way round: X becomes -X, seen with the same normal.
    const std::vector<GltfPart> mirrored =
        decodeBrushed(brushed(double(kPi) / 6), R"({"mesh":0,"scale":[-1,1,1]})");
    for (const vec3& tangent : mirrored[0].mesh.tangents)
        CHECK(glm::distance(tangent, vec3(-0.5f, sine, 0)) < 1e-5f);
    for (const vec3& tangent : mirrored[1].mesh.tangents)
        CHECK(glm::distance(tangent, vec3(-1, 0, 0)) < 1e-5f);
}

TEST_CASE("glTF extensions: without tangents, anisotropy follows texture coordinates, if there are any") {
    const std::string brushed = R"("extensions":{"KHR_materials_anisotropy":{"anisotropyStrength":0.5}})";
    const GltfPart bare = decodeMaterial(brushed);
    CHECK(bare.mesh.tangents.empty());
    CHECK(bare.mesh.uvs.size() == 6); // kept though it has no texture: the bake's tangents follow them
    CHECK(decodeMaterial(R"("name":"plain")").mesh.uvs.empty());
    const LogCapture log;
    TexturedGlb glb;
    glb.primitives = R"([{"attributes":{"POSITION":0,"NORMAL":1},"indices":3,"material":0}])";
    glb.materials = "[{" + brushed + "}]";
    CHECK(decodeGlb(glb.bytes()).parts[0].mesh.uvs.empty());
    CHECK(log.says("directions of anisotropy"));
}
