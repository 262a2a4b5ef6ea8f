#include "engine/import/mesh_formats.h"

#include "engine/base/error.h"
#include "engine/base/hash.h"
#include "engine/import/mesh_file.h"
#include "tests/support/failure.h"
#include "tests/support/log_capture.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/textured_glb.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <random>

using namespace relume;
using namespace relume::test;

namespace {

std::string partsFailure(const TexturedGlb& glb, const std::filesystem::path& folder = "") {
    return failureOf([&] { decodeGlb(glb.bytes(), folder); });
}

} // namespace

TEST_CASE("glTF parts: two textured materials come in apart, each with its own") {
    const GltfParts file = decodeGlb(TexturedGlb().bytes());
    REQUIRE(file.parts.size() == 2);
    const GltfPart &red = file.parts[0], &blue = file.parts[1];
    CHECK(red.name == "red");
    CHECK(red.material ==
          R"({"name":"red","model":"gltf","base_color":[0.5,0.25,1.0],"metallic":0.0,"roughness":0.75})");
    REQUIRE(red.baseColor);
    CHECK(red.baseColor->srgb);
    CHECK(red.baseColor->texels == TexturedGlb::kRed.texels);
    CHECK(blue.name == "material 1");
    CHECK(
        blue.material ==
        R"({"name":"material 1","model":"gltf","base_color":[1.0,1.0,1.0],"metallic":1.0,"roughness":1.0})");
    REQUIRE(blue.baseColor);
    CHECK(blue.baseColor->texels == TexturedGlb::kBlue.texels);
    CHECK(file.images.empty());
    // Both quads have a seam through their middle: four corners, of which two are double.
    for (const GltfPart& part : file.parts) {
        CHECK(part.mesh.triangleCount() == 2);
        REQUIRE(part.mesh.vertexCount() == 6);
        REQUIRE(part.mesh.uvs.size() == 6);
        CHECK(part.mesh.normals[0] == vec3(0, 0, 1));
    }
    CHECK(red.mesh.uvs[red.mesh.triangles[1].y] == vec2(0.75f, 0.5f));
    CHECK(blue.mesh.positions[blue.mesh.triangles[0].x].z == 1);
    // The same file as one mesh, whose seams nothing needs.
    const std::string bytes = TexturedGlb().bytes();
    const Mesh whole = decodeMesh(std::as_bytes(std::span(bytes)), "a.glb", UpAxis::Y);
    CHECK(whole.vertexCount() == 8);
    CHECK(whole.uvs.empty());
    const Mesh seams = decodeMesh(std::as_bytes(std::span(bytes)), "a.glb", UpAxis::Y, {true, true});
    CHECK(seams.uvs.size() == 12);
    CHECK(seams.colors.empty());
}

TEST_CASE("glTF parts: images as data, as files, and from nowhere else") {
    TexturedGlb data;
    data.images = R"([{"uri":"data:image/png;base64,)" + encodeBase64(samplePng(TexturedGlb::kBlue)) +
                  R"("},{"bufferView":5}])";
    CHECK(decodeGlb(data.bytes()).parts[0].baseColor->texels == TexturedGlb::kBlue.texels);

    const TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "inner/maps");
    const std::string png = samplePng(TexturedGlb::kRed);
    folder.write("inner/maps/red wood.png", png);
    folder.write("outside.png", png);
    folder.write("inner/broken.png", png.substr(0, png.size() - 9));
    const auto withImage = [](const std::string& uri) {
        TexturedGlb glb;
        glb.images = R"([{"uri":")" + uri + R"("},{"bufferView":5}])";
        return glb;
    };
    const std::filesystem::path inner = folder.path() / "inner";
    const GltfParts file = decodeGlb(withImage("maps/red%20wood.png").bytes(), inner);
    CHECK(file.parts[0].baseColor->texels == TexturedGlb::kRed.texels);
    REQUIRE(file.images.size() == 1);
    CHECK(says(file.images[0].file, "red wood.png"));
    CHECK(file.images[0].hash == hashText(std::as_bytes(std::span(png))));
    CHECK(says(partsFailure(withImage("../outside.png"), inner), "folder"));
    CHECK(says(partsFailure(withImage("%2e%2e/outside.png"), inner), "folder"));
    CHECK(says(partsFailure(withImage((folder.path() / "outside.png").string()), inner), "folder"));
    CHECK(says(partsFailure(withImage("missing.png"), inner), "missing.png"));
    CHECK(says(partsFailure(withImage("maps"), inner), "no file"));
    CHECK(says(partsFailure(withImage(""), inner), "images[0]"));
    CHECK(says(partsFailure(withImage("broken.png"), inner), "images[0]"));
    CHECK(says(partsFailure(withImage("data:image/png;base64,AAAA"), inner), "PNG or JPEG"));
}

TEST_CASE("glTF parts: metalness and roughness are averaged, texture coordinates transformed") {
    TexturedGlb glb;
    // The red image's texels have G of 0 and 255 and B of 0 in equal shares.
    glb.materials = R"([{"pbrMetallicRoughness":{"metallicFactor":0.5,"roughnessFactor":0.5,
        "metallicRoughnessTexture":{"index":0},"baseColorTexture":{"index":1,"extensions":{
        "KHR_texture_transform":{"offset":[1,2],"rotation":1.5707963267948966,"scale":[4,2]}}}}},
        {"name":"material 0"}])";
    const GltfParts file = decodeGlb(glb.bytes());
    REQUIRE(file.parts.size() == 2);
    CHECK(file.parts[0].material.find("\"metallic\":0.0,\"roughness\":0.25") != std::string::npos);
    // (0.75, 0.5) is scaled to (3, 1), turned counter-clockwise, u to the lesser v, and moved.
    const Mesh& mesh = file.parts[0].mesh;
    CHECK(glm::distance(mesh.uvs[mesh.triangles[1].y], vec2(1 + 1, 2 - 3)) < 1e-5f);
    CHECK(file.parts[1].name == "material 0 (1)");
    CHECK(file.parts[1].mesh.uvs.empty());
    CHECK(file.parts[1].mesh.vertexCount() == 4);
}

TEST_CASE("glTF parts: what is not supported is ignored, factors are clamped") {
    TexturedGlb glb;
    glb.materials = R"([{"pbrMetallicRoughness":{"baseColorFactor":[2,-1,0.5,0.25],"metallicFactor":7},
        "occlusionTexture":{"index":77},"alphaMode":"BLEND",
        "extensions":{"KHR_materials_volume":{"thicknessTexture":[[[]]]}},"extras":[[[]]]},
        {"pbrMetallicRoughness":{"baseColorTexture":{"index":1,"texCoord":3}}}])";
    const GltfParts file = decodeGlb(glb.bytes());
    REQUIRE(file.parts.size() == 2);
    CHECK(
        file.parts[0].material ==
        R"({"name":"material 0","model":"gltf","base_color":[1.0,0.0,0.5],"metallic":1.0,"roughness":1.0})");
    CHECK(!file.parts[1].baseColor); // there is no TEXCOORD_3
    glb.primitives = R"([{"attributes":{"POSITION":0,"NORMAL":1},"indices":3}])";
    const GltfParts bare = decodeGlb(glb.bytes());
    REQUIRE(bare.parts.size() == 1);
    CHECK(bare.parts[0].name == "default material");
}

TEST_CASE("glTF parts: metalness and roughness that vary become a set and its weights") {
    TexturedGlb glb;
    // The red image: G of 0 and 255, B of 0; so two roughnesses.
    glb.materials = R"([{"name":"tin","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,1],
        "roughnessFactor":0.8,"metallicRoughnessTexture":{"index":0},"baseColorTexture":{"index":1}}},{}])";
    const GltfPart part = decodeGlb(glb.bytes()).parts[0];
    const nlohmann::json set = nlohmann::json::parse(part.material)["set"];
    REQUIRE(set.size() == 4);
    CHECK(set[0]["name"] == "tin (metallic 0.00, roughness 0.14)");
    CHECK(set[3]["roughness"].get<double>() == doctest::Approx(0.8));
    CHECK(set[3]["base_color"] == nlohmann::json({0.5, 0.5, 0.5}));
    REQUIRE(part.materialMap);
    CHECK(part.materialMap->texels == std::vector<uint32_t>{0xff, 0xff000000});
    CHECK(part.baseColor.has_value());
    // Without texture coordinates its mean is all there is.
    glb.primitives = R"([{"attributes":{"POSITION":0,"NORMAL":1},"indices":3,"material":0}])";
    const GltfPart bare = decodeGlb(glb.bytes()).parts[0];
    CHECK(!bare.materialMap);
    CHECK(says(bare.material, "\"metallic\":0.0,\"roughness\":0.4"));
}

TEST_CASE("glTF parts: normal maps, emission and vertex colors") {
    TexturedGlb glb;
    glb.materials = R"([{"normalTexture":{"index":1,"scale":0.5},"emissiveFactor":[1,0.5,0],
        "emissiveTexture":{"index":0},"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4}}},
        {"normalTexture":{"index":1,"texCoord":1},"pbrMetallicRoughness":{"baseColorTexture":{"index":0}},
        "emissiveFactor":[0,0,3]}])";
    const GltfParts file = decodeGlb(glb.bytes());
    const SurfaceDetail &first = file.parts[0].detail, &second = file.parts[1].detail;
    REQUIRE(first.normalMap);
    CHECK(!first.normalMap->srgb);
    CHECK(first.normalMap->texels == TexturedGlb::kBlue.texels);
    CHECK(first.normalScale == 0.5f);
    CHECK(first.emission == vec3(4, 2, 0));
    REQUIRE(first.emissionMap);
    CHECK(first.emissionMap->srgb);
    CHECK(!second.normalMap); // it lies elsewhere than the base color
    CHECK(second.emission == vec3(0, 0, 3));
    CHECK(!second.emissionMap);
    CHECK(file.parts[0].mesh.colors.empty());
    // Normals as colors: (0, 0, 1) at every corner.
    glb.primitives = R"([{"attributes":{"POSITION":0,"NORMAL":1,"COLOR_0":1},"indices":3,"material":0}])";
    const GltfPart tinted = decodeGlb(glb.bytes()).parts[0];
    REQUIRE(tinted.mesh.colors.size() == tinted.mesh.vertexCount());
    CHECK(vec3(tinted.mesh.colors[0]) == vec3(0, 0, 1));
    CHECK(!tinted.detail.normalMap); // no texture coordinates
    CHECK(tinted.detail.emission == vec3(0));
    // A primitive of the same material without colors is white, and so is one whose colors cannot be read.
    glb.primitives = R"([{"attributes":{"POSITION":0,"NORMAL":1,"COLOR_0":1},"indices":3,"material":0},
        {"attributes":{"POSITION":0,"NORMAL":1},"indices":4,"material":0},
        {"attributes":{"POSITION":0,"NORMAL":1,"COLOR_0":77},"indices":4,"material":1}])";
    const GltfParts mixed = decodeGlb(glb.bytes());
    const std::vector<vec4>& colors = mixed.parts[0].mesh.colors;
    REQUIRE(colors.size() == mixed.parts[0].mesh.vertexCount());
    CHECK(std::ranges::count(colors, vec4(1)) == std::ptrdiff_t(colors.size() / 2));
    CHECK(mixed.parts[1].mesh.colors.empty());
}

TEST_CASE("glTF parts: masks cut holes, and so do blended textures that are nearly masks") {
    const auto withAlpha = [](const std::string& first, const std::string& second) {
        TexturedGlb glb;
        glb.materials = "[{" + first + R"(,"pbrMetallicRoughness":{"baseColorTexture":{"index":1}}},{)" +
                        second + R"(,"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.25]}}])";
        return decodeGlb(glb.bytes()).parts;
    };
    const auto lowest = [](const Mesh& mesh) {
        float low = 1;
        for (const vec2& uv : mesh.uvs) low = std::min(low, uv.y);
        return low;
    };
    // The blue image: alpha 1 above and 0.5 below, v from 0 to 0.5 on the square; 0.75 in the middle, 1 at
    // 0.25.
    std::vector<GltfPart> parts = withAlpha(R"("alphaMode":"MASK","alphaCutoff":0.875)", R"("name":"b")");
    REQUIRE(parts.size() == 2);
    CHECK(lowest(parts[0].mesh) == doctest::Approx(0.125).epsilon(0.01));
    CHECK(parts[1].mesh.triangleCount() == 2); // opaque: its factor's alpha does not count
    parts = withAlpha(R"("alphaMode":"OPAQUE")", R"("alphaMode":"MASK")");
    REQUIRE(parts.size() == 1); // nothing is left of the other
    CHECK(lowest(parts[0].mesh) == 0);
    const LogCapture log;
    parts = withAlpha(R"("alphaMode":"BLEND")", R"("alphaMode":"BLEND")");
    REQUIRE(parts.size() == 2);
    CHECK(lowest(parts[0].mesh) == 0);
    CHECK(log.says("alphaMode BLEND"));
    TexturedGlb glb;
    const uint32_t on = 0xffffffff, off = 0x00ffffff; // off from v = 0.25 to 0.5
    glb.images = R"([{"uri":"data:image/png;base64,)" +
                 encodeBase64(samplePng({1, 8, {on, on, off, off, on, on, on, on}, true})) +
                 R"("},{"bufferView":5}])";
    glb.materials = R"([{"alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}},{}])";
    float highest = 0;
    const Mesh masked = decodeGlb(glb.bytes()).parts[0].mesh;
    for (const vec2& uv : masked.uvs) highest = std::max(highest, uv.y);
    CHECK(highest == doctest::Approx(0.25).epsilon(0.01));
    // Colors without alpha are opaque.
    glb.primitives = R"([{"attributes":{"POSITION":0,"NORMAL":1,"COLOR_0":1},"indices":3,"material":0}])";
    glb.materials = R"([{"alphaMode":"MASK"}])";
    CHECK(decodeGlb(glb.bytes()).parts[0].mesh.triangleCount() == 2);
}

TEST_CASE("glTF parts: scales of normals are bounded") {
    TexturedGlb glb;
    glb.materials = R"([{"normalTexture":{"index":1,"scale":1e300}},{}])";
    CHECK(decodeGlb(glb.bytes()).parts[0].detail.normalScale == kLargestNormalScale);
}

TEST_CASE("glTF parts: materials that lie") {
    const auto withMaterial = [](const std::string& material) {
        TexturedGlb glb;
        glb.materials = "[" + material + ",{}]";
        return partsFailure(glb);
    };
    const auto withSurface = [&](const std::string& surface) {
        return withMaterial(R"({"pbrMetallicRoughness":)" + surface + "}");
    };
    CHECK(withSurface("{}") == "");
    CHECK(says(withMaterial("7"), "materials[0]"));
    CHECK(says(withMaterial(R"({"name":7})"), "name"));
    CHECK(says(withSurface("[]"), "pbrMetallicRoughness"));
    CHECK(says(withSurface(R"({"baseColorFactor":[1,1,1]})"), "4 numbers"));
    CHECK(says(withSurface(R"({"roughnessFactor":"1"})"), "roughnessFactor"));
    CHECK(says(withSurface(R"({"baseColorTexture":{"index":9}})"), "number 9 of its textures"));
    CHECK(says(withSurface(R"({"baseColorTexture":{"index":-1}})"), "index"));
    CHECK(says(withSurface(R"({"baseColorTexture":{"index":99999999999}})"), "index"));
    CHECK(withSurface(R"({"baseColorTexture":{}})") == "");
    TexturedGlb glb;
    glb.textures = R"([{"source":4},{"source":0}])";
    CHECK(says(partsFailure(glb), "number 4 of its images"));
    glb.textures = R"([{"extensions":{"KHR_texture_basisu":{"source":0}}},{"source":0}])";
    CHECK(says(partsFailure(glb), "PNG or JPEG"));
    glb.textures = R"([{"source":0,"sampler":3},{"source":0}])";
    CHECK(says(partsFailure(glb), "samplers"));
    glb = {};
    glb.images = R"([{"bufferView":77},{"bufferView":5}])";
    CHECK(says(partsFailure(glb), "buffer view 77"));
    glb.images = R"([{"bufferView":0},{"bufferView":5}])";
    CHECK(says(partsFailure(glb), "PNG or JPEG"));
    glb = {};
    glb.materials = "[{}]";
    CHECK(says(partsFailure(glb), "number 1 of its materials"));
    glb.materials = "5";
    CHECK(says(partsFailure(glb), "number 0 of its materials"));
}

TEST_CASE("glTF parts: one small image that many materials have does not become gigabytes") {
    TexturedGlb glb;
    constexpr int kSide = 2048, kMaterials = 21; // 21 · 2048² texels, of 4 bytes
    const std::string png = samplePng({kSide, kSide, std::vector<uint32_t>(kSide * kSide, 0xff808080), true});
    glb.images =
        fmt::format(R"([{{"uri":"data:image/png;base64,{}"}},{{"bufferView":5}}])", encodeBase64(png));
    glb.materials = glb.primitives = "";
    for (int i = 0; i < kMaterials; i++) {
        glb.materials += R"({"pbrMetallicRoughness":{"metallicRoughnessTexture":{"index":0}}},)";
        glb.primitives += fmt::format(
            R"({{"attributes":{{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}},"indices":3,"material":{}}},)", i);
    }
    for (std::string* list : {&glb.materials, &glb.primitives}) {
        list->back() = ']'; // instead of a comma
        list->insert(0, 1, '[');
    }
    CHECK(glb.bytes().size() < 300'000);
    CHECK(says(partsFailure(glb), "texels in all"));
}

TEST_CASE("glTF parts: truncated anywhere or with any bit flipped, parts or an Error") {
    const std::string bytes = TexturedGlb().bytes();
    std::mt19937 random(3);
    const auto tryDecode = [](const std::string& damaged) {
        try {
            decodeGlb(damaged);
        } catch (const Error&) {
        }
    };
    for (size_t size = 0; size < bytes.size(); size += 7) tryDecode(bytes.substr(0, size));
    for (int i = 0; i < 1000; i++) {
        std::string damaged = bytes;
        for (int flips = 1 + i % 3; flips > 0; flips--)
            damaged[random() % damaged.size()] ^= char(1u << (random() % 8));
        tryDecode(damaged);
    }
    CHECK(decodeGlb(bytes).parts.size() == 2);
}
