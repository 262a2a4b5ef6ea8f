#include "engine/import/scene.h"

#include "engine/base/error.h"
#include "engine/base/hash.h"
#include "engine/base/nearest_name.h"
#include "engine/import/builtin_mesh.h"
#include "tests/support/failure.h"
#include "tests/support/mesh_samples.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/textured_glb.h"

#include <doctest/doctest.h>

using namespace relume;
using namespace relume::test;

namespace {

std::string sceneFailure(const std::string& text) {
    const TemporaryFolder folder;
    return failureOf([&] { readScene(folder.write("scene.json", text)); });
}

} // namespace

TEST_CASE("scene: built-in meshes, files, transforms, ground") {
    const TemporaryFolder folder;
    const std::string obj = sampleObj(makeSphere(1));
    folder.write("ball.obj", obj);
    const Scene scene = readScene(folder.write("scene.json", R"({
        "parts": [
            {"mesh": "ball.obj", "material": "clay", "scale": 2, "rotate": [0, 90, 0], "translate": [5, 2, 0]},
            {"name": "floor lamp", "mesh": "torus", "up": "z", "material": {"model": "ashikhmin-shirley", "nu": 10},
             "brush_rotation": 90}
        ],
        "ground": {"tessellation": 8, "extent": 2, "material": "gray"}
    })"));
    REQUIRE(scene.parts.size() == 3);
    CHECK(scene.parts[0].name == "ball");
    CHECK(scene.parts[0].source == (folder.path() / "ball.obj").string());
    CHECK(scene.parts[0].sourceHash == hashText(std::as_bytes(std::span(obj))));
    const Mesh sphere = makeSphere(1);
    const vec3 p = sphere.positions[0];
    CHECK(glm::distance(scene.parts[0].mesh.positions[0], vec3(5, 2, 0) + 2.0f * vec3(p.z, p.y, -p.x)) <
          1e-5f);
    CHECK(glm::distance(scene.parts[0].mesh.normals[0], vec3(p.z, p.y, -p.x)) < 1e-5f);

    CHECK(scene.parts[1].name == "floor lamp");
    CHECK(scene.parts[1].source == "built-in torus");
    CHECK(scene.parts[0].brushRotation == 0);
    CHECK(scene.parts[1].brushRotation == 90);
    CHECK(scene.parts[1].sourceHash.empty());
    CHECK(scene.parts[1].material == R"({"model":"ashikhmin-shirley","nu":10})");
    CHECK(boundsOf(scene.parts[1].mesh).extent().y ==
          doctest::Approx(2).epsilon(1e-2)); // its axis was Y, is Z

    CHECK(scene.parts[2].material == "gray");
    CHECK(scene.parts[2].mesh.vertexCount() == 81);
    CHECK(boundsOf(scene.parts[2].mesh).low.y == doctest::Approx(-1).epsilon(1e-2));
}

TEST_CASE("scene: turns about x, then y, then z") {
    const TemporaryFolder folder;
    folder.write("a.obj", "v 0 0 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Scene scene = readScene(folder.write(
        "scene.json",
        R"({"parts": [{"mesh": "a.obj", "material": "clay", "rotate": [90, 90, 0]}], "ground": false})"));
    REQUIRE(scene.parts.size() == 1);
    // z: about x to -y, which y leaves alone. y: about x to z, about y to x.
    CHECK(glm::distance(scene.parts[0].mesh.positions[0], vec3(0, -1, 0)) < 1e-6f);
    CHECK(glm::distance(scene.parts[0].mesh.positions[2], vec3(1, 0, 0)) < 1e-6f);
}

TEST_CASE("scene: errors name the place, the key and the remedy") {
    const auto part = [](const std::string& more) {
        return R"({"parts": [{"mesh": "sphere", "material": "clay"}, {"mesh": "sphere", "material": "clay")" +
               more + "}]}";
    };
    CHECK(sceneFailure(part("")) == "");
    const std::string unknown = sceneFailure(part(R"(, "tranlate": [0, 0, 0])"));
    CHECK(unknown.find("scene.json: parts[1]") != std::string::npos);
    CHECK(unknown.find("did you mean \"translate\"") != std::string::npos);
    CHECK(sceneFailure(part(R"(, "translate": [0, 0])")).find("three numbers") != std::string::npos);
    CHECK(sceneFailure(part(R"(, "translate": [0, 0, "1"])")).find("translate") != std::string::npos);
    CHECK(sceneFailure(part(R"(, "scale": 0)")).find("scale") != std::string::npos);
    CHECK(sceneFailure(part(R"(, "scale": 1e300)")).find("scale") != std::string::npos);
    CHECK(sceneFailure(part(R"(, "up": "x")")).find("\"y\" or \"z\"") != std::string::npos);
    CHECK(sceneFailure(part(R"(, "name": 7)")).find("name") != std::string::npos);
    CHECK(sceneFailure(R"({"parts": [{"mesh": "sphere"}]})").find("material") != std::string::npos);
    CHECK(sceneFailure(R"({"parts": [{"material": "clay"}]})").find("mesh") != std::string::npos);
    CHECK(sceneFailure(R"({"parts": [{"mesh": "none.obj", "material": "clay"}]})").find("none.obj") !=
          std::string::npos);
    CHECK(sceneFailure(R"({"parts": []})").find("parts") != std::string::npos);
    for (const char* text : {"{}", R"({"parts": 5})", R"({"ground": true})"})
        CHECK(says(sceneFailure(text), "\"parts\": expected a list"));
    CHECK(says(sceneFailure(R"({"a\"": )" + std::string(200'000, '[') + std::string(200'000, ']') + "}"),
               "nested deeper"));
    CHECK(sceneFailure(R"({"part": []})").find("did you mean \"parts\"") != std::string::npos);
    CHECK(sceneFailure(R"([1])").find("object") != std::string::npos);
    CHECK(sceneFailure("{\"parts\": [").find("not valid JSON") != std::string::npos);
    CHECK(sceneFailure("").find("not valid JSON") != std::string::npos);
    CHECK(sceneFailure(std::string(100000, '[')).find("deeper") != std::string::npos);
    const std::string start = R"({"parts": [{"mesh": "sphere", "material": "clay"}], "ground": )";
    CHECK(sceneFailure(start + R"({"tessellation": 1e9}})").find("tessellation") != std::string::npos);
    CHECK(sceneFailure(start + R"({"tessellation": 1.5}})").find("whole") != std::string::npos);
    CHECK(sceneFailure(start + R"({"size": 2}})").find("unknown key \"size\"") != std::string::npos);
    CHECK(sceneFailure(start + "3}").find("object") != std::string::npos);
    CHECK(sceneFailure(start + "true}") == "");
}

TEST_CASE("scene: parts painted by textures or by vertex colors") {
    const TemporaryFolder folder;
    const std::string base = samplePng(TexturedGlb::kRed), weights = samplePng(TexturedGlb::kBlue);
    folder.write("base.png", base);
    folder.write("weights.png", weights);
    folder.write("painted.ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                 "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                 "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                 "0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n3 0 1 2\n");
    const Scene scene = readScene(folder.write("scene.json", R"({"parts": [
        {"mesh": "plane", "material": {"set": ["clay", "red"]}, "base_color": "base.png", "material_map": "weights.png"},
        {"mesh": "painted.ply", "material": {"set": ["clay", "red"]}, "material_map": "colors"},
        {"mesh": "sphere", "material": "clay"}]})"));
    REQUIRE(scene.parts.size() == 3);
    const Part &textured = scene.parts[0], &painted = scene.parts[1], &plain = scene.parts[2];
    CHECK(textured.material == R"({"set":["clay","red"]})");
    REQUIRE(textured.baseColor);
    REQUIRE(textured.materialMap);
    CHECK(textured.baseColor->srgb);
    CHECK(!textured.materialMap->srgb);
    CHECK(textured.materialMap->texels == TexturedGlb::kBlue.texels);
    CHECK(textured.mesh.uvs.size() == textured.mesh.vertexCount());
    CHECK(!textured.paintedByColors);
    REQUIRE(textured.textureFiles.size() == 2);
    CHECK(textured.textureFiles[1].file == (folder.path() / "weights.png").string());
    CHECK(textured.textureFiles[1].hash == hashText(std::as_bytes(std::span(weights))));
    CHECK(painted.paintedByColors);
    CHECK(painted.mesh.colors[1] == vec4(0, 1, 0, 0));
    CHECK(painted.mesh.uvs.empty());
    CHECK(!plain.baseColor);
    CHECK(!plain.materialMap);
    CHECK(plain.mesh.uvs.empty());
}

TEST_CASE("scene: a glTF file without a named material keeps its own") {
    const TemporaryFolder folder;
    folder.write("a.glb", TexturedGlb().bytes());
    folder.write("base.png", samplePng(TexturedGlb::kBlue));
    const Scene own = readScene(folder.write(
        "own.json",
        R"({"parts": [{"mesh": "a.glb", "up": "z", "translate": [5, 0, 0]}, {"mesh": "a.glb", "name": "box"}]})"));
    REQUIRE(own.parts.size() == 4);
    CHECK(own.parts[0].name == "red");
    CHECK(own.parts[0].source == (folder.path() / "a.glb").string());
    CHECK(!own.parts[1].sourceHash.empty());
    CHECK(boundsOf(own.parts[1].mesh).low == vec3(5, 1, -1));
    CHECK(own.parts[1].baseColor);
    CHECK(own.parts[2].name == "box: red");
    CHECK(own.parts[3].name == "box: material 1");
    const Scene named = readScene(folder.write(
        "named.json",
        R"({"parts": [{"mesh": "a.glb", "material": "clay"}, {"mesh": "a.glb", "material": "clay", "base_color": "base.png"}]})"));
    REQUIRE(named.parts.size() == 2);
    CHECK(named.parts[0].name == "a");
    CHECK(named.parts[0].mesh.vertexCount() == 8);
    CHECK(!named.parts[0].baseColor);
    CHECK(named.parts[1].mesh.vertexCount() == 12);
    CHECK(named.parts[1].baseColor->texels == TexturedGlb::kBlue.texels);
}

TEST_CASE("scene: what is placed where single precision would round its shape is refused") {
    const auto placed = [](const std::string& more) {
        return sceneFailure(R"({"parts": [{"mesh": "sphere", "material": "clay", )" + more + "}]}");
    };
    CHECK(placed(R"("translate": [9000, 0, 0])") == "");
    CHECK(placed(R"("translate": [0, 1e9, 0])").find("parts[0]: is 2 units large") != std::string::npos);
    CHECK(placed(R"("translate": [0, 0, -1], "scale": 1e-9)").find("move it nearer") != std::string::npos);
    const TemporaryFolder folder;
    const std::string far =
        folder.write("far.obj", "v 4e6 5e5 0\nv 4e6 500100 0\nv 4000100 5e5 0\nf 1 2 3\n");
    CHECK_THROWS_WITH_AS(loadParts(far, UpAxis::Y, "clay"), doctest::Contains("far.obj: is 100 units large"),
                         Error);
}

TEST_CASE("scene: paint that does not fit its mesh") {
    const TemporaryFolder folder;
    folder.write("bare.obj", sampleObj(makeSphere(0)));
    folder.write("a.glb", TexturedGlb().bytes());
    folder.write("base.png", samplePng(TexturedGlb::kRed));
    folder.write("broken.png", samplePng(TexturedGlb::kRed).substr(0, 40));
    const auto failure = [&](const std::string& part) {
        try {
            readScene(folder.write("scene.json", R"({"parts": [{)" + part + "}]}"));
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const auto says = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    const std::string bare = R"("mesh": "bare.obj", "material": "clay", )",
                      plane = R"("mesh": "plane", "material": "clay", )";
    CHECK(says(failure(bare + R"("base_color": "base.png")"), "bare.obj: has no texture coordinates"));
    CHECK(says(failure(bare + R"("material_map": "base.png")"), "unwrap"));
    CHECK(says(failure(bare + R"("material_map": "colors")"), "no vertex colors"));
    CHECK(says(failure(plane + R"("base_color": "missing.png")"), "missing.png"));
    CHECK(says(failure(plane + R"("base_color": "broken.png")"), "broken.png"));
    CHECK(says(failure(plane + R"("base_color": 7)"), "base_color"));
    CHECK(says(failure(plane + R"("material_maps": "base.png")"), "did you mean \"material_map\""));
    CHECK(says(failure(R"("mesh": "a.glb", "base_color": "base.png")"), "material"));
    CHECK(says(failure(R"("mesh": "bare.obj")"), "material"));
    CHECK(failure(plane + R"("base_color": "base.png")") == "");
}

TEST_CASE("nearest name: the fewest edits") {
    static constexpr std::string_view kNames[] = {"clay", "dark-skin", "red-plastic"};
    CHECK(nearestName("darkskin", kNames) == "dark-skin");
    CHECK(nearestName("red plastic", kNames) == "red-plastic");
    CHECK(nearestName("", kNames) == "clay");
    CHECK(nearestName(std::string(1 << 20, 'k'), kNames) == "dark-skin");
}
