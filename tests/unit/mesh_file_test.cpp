#include "engine/import/mesh_file.h"

#include "engine/base/error.h"
#include "engine/import/builtin_mesh.h"
#include "engine/import/mesh_cleanup.h"
#include "engine/import/polygon.h"
#include "tests/support/failure.h"
#include "tests/support/mesh_samples.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/textured_glb.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <random>

using namespace relume;
using namespace relume::test;

namespace {

Mesh decode(const std::string& text, const std::string& name, UpAxis up = UpAxis::Y,
            MeshAttributes wanted = {}) {
    return decodeMesh(std::as_bytes(std::span(text)), name, up, wanted);
}

constexpr MeshAttributes kAll{true, true};

// The text of the Error that decoding throws, or "" if it does not.
std::string meshFailure(const std::string& text, const std::string& name, MeshAttributes wanted = {}) {
    return failureOf([&] { decode(text, name, UpAxis::Y, wanted); });
}

// The same triangles in the same order; vertices may be numbered otherwise.
void checkSame(const Mesh& found, const Mesh& expected) {
    REQUIRE(found.vertexCount() == expected.vertexCount());
    REQUIRE(found.triangleCount() == expected.triangleCount());
    float worst = 0;
    for (size_t i = 0; i < found.triangleCount(); i++)
        for (int corner = 0; corner < 3; corner++) {
            const uint32_t a = found.triangles[i][corner], b = expected.triangles[i][corner];
            worst = std::max(worst, glm::distance(found.positions[a], expected.positions[b]) +
                                        glm::distance(found.normals[a], expected.normals[b]));
        }
    CHECK(worst < 1e-5f);
}

} // namespace

TEST_CASE("mesh files: every format gives the same sphere") {
    const Mesh sphere = makeSphere(2);
    checkSame(decode(sampleObj(sphere), "sphere.obj"), sphere);
    checkSame(decode(samplePly(sphere, PlySample::Ascii), "sphere.ply"), sphere);
    checkSame(decode(samplePly(sphere, PlySample::LittleEndian), "sphere.PLY"), sphere);
    checkSame(decode(samplePly(sphere, PlySample::BigEndian), "sphere.ply"), sphere);
    checkSame(decode(sampleGlb(sphere), "sphere.glb"), sphere);
}

TEST_CASE("mesh files: Z up is turned, not mirrored") {
    const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    const Mesh mesh = decode(text, "a.obj", UpAxis::Z);
    CHECK(boundsOf(mesh).high == vec3(1, 2, 0));
    CHECK(boundsOf(mesh).low == vec3(0, 0, -1));
    CHECK(mesh.triangles == decode(text, "a.obj").triangles);
}

TEST_CASE("mesh files: polygons, welding, degenerate and unused parts") {
    // Two quads that repeat two corners, a face without area, a vertex without a face, an index from the end.
    const Mesh mesh = decode("v 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nv 1 -0 0\r\nv 9 9 9\r\nv 1 1 0\r\n"
                             "v 2 0 0\r\nv 2 1 0\r\nf 1 2 3 4\r\nf 5 8 -1 7\r\nf 2 5 3\r\nf 1 2\r\n",
                             "a.obj");
    CHECK(mesh.vertexCount() == 6);
    CHECK(mesh.triangleCount() == 4);
    for (const vec3& normal : mesh.normals) CHECK(glm::distance(normal, vec3(0, 0, 1)) < 1e-6f);
}

TEST_CASE("mesh files: normals keep creases apart, incomplete or broken ones are made anew") {
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    const Mesh crease = decode(corners + "vn 0 0 5\nvn 5 0 0\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n", "a.obj");
    CHECK(crease.vertexCount() == 6);
    CHECK(crease.normals[0] == vec3(0, 0, 1));
    const Mesh partial = decode(corners + "vn 0 0 5\nf 1//1 2//1 3//1\nf 1 3 4\n", "a.obj");
    CHECK(partial.vertexCount() == 4);
    const Mesh zero = decode(corners + "vn 0 0 0\nvn 5 0 0\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n", "a.obj");
    CHECK(zero.vertexCount() == 4);
    CHECK(zero.normals[0] == partial.normals[0]);
    Mesh strange;
    strange.positions = {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)};
    strange.triangles = {uvec3(0, 1, 2)};
    for (const float wrong : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
        strange.normals.assign(3, vec3(0, 0, wrong));
        CHECK(cleanUp(strange, "a").normals == std::vector<vec3>(3, vec3(0, 0, 1)));
    }
}

TEST_CASE("OBJ: texture coordinates from the top left, where wanted, split vertices along seams") {
    const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 0.5 0.25 9\n"
                             "f 1/1 2/2 3/3\nf 2/2 4/4 3/1\n";
    CHECK(decode(text, "a.obj").vertexCount() == 4);
    CHECK(decode(text, "a.obj").uvs.empty());
    const Mesh mesh = decode(text, "a.obj", UpAxis::Y, kAll);
    REQUIRE(mesh.vertexCount() == 5); // vertex 3 has two, vertex 2 has one
    REQUIRE(mesh.uvs.size() == 5);
    CHECK(mesh.colors.empty());
    CHECK(mesh.uvs[mesh.triangles[0].x] == vec2(0, 1));
    CHECK(mesh.uvs[mesh.triangles[0].z] == vec2(0, 0));
    CHECK(mesh.uvs[mesh.triangles[1].y] == vec2(0.5f, 0.75f));
    CHECK(mesh.uvs[mesh.triangles[1].z] == vec2(0, 1));
    CHECK(decode(text + "f 1 2 4\n", "a.obj", UpAxis::Y, kAll).uvs.empty());
    CHECK(meshFailure("vt x 0\n" + text, "a.obj", kAll).find("line 1") != std::string::npos);
    CHECK(meshFailure("vt 0 1e999\n" + text, "a.obj", kAll).find("line 1") != std::string::npos);
    CHECK(meshFailure(text + "f 1/9 2/2 3/3\n", "a.obj", kAll).find("coordinates 9") != std::string::npos);
}

TEST_CASE("PLY: texture coordinates and colors under their several names") {
    for (const auto& [u, v] :
         {std::pair("s", "t"), std::pair("u", "v"), std::pair("texture_u", "texture_v")}) {
        const std::string text =
            fmt::format("ply\nformat ascii 1.0\nelement vertex 3\nproperty float {}\nproperty float x\n"
                        "property float y\nproperty float z\nproperty float {}\nproperty uchar blue\n"
                        "property uchar green\nproperty uchar red\nelement face 1\n"
                        "property list uchar int vertex_indices\nend_header\n"
                        "0 0 0 0 0 255 0 51\n1 1 0 0 0 0 0 0\n0.25 0 1 0 1 0 255 0\n3 0 1 2\n",
                        u, v);
        CHECK(decode(text, "a.ply").uvs.empty());
        CHECK(decode(text, "a.ply").colors.empty());
        const Mesh mesh = decode(text, "a.ply", UpAxis::Y, kAll);
        REQUIRE(mesh.uvs.size() == 3);
        REQUIRE(mesh.colors.size() == 3);
        CHECK(mesh.uvs[0] == vec2(0, 1));
        CHECK(mesh.uvs[2] == vec2(0.25f, 0));
        CHECK(glm::distance(mesh.colors[0], vec4(0.2f, 0, 1, 0)) < 1e-6f);
        CHECK(mesh.colors[2] == vec4(0, 1, 0, 0));
    }
    const std::string floats =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nproperty float red\nproperty float green\nproperty float blue\n"
        "property float alpha\nelement face 1\nproperty list uchar int vertex_indices\n"
        "end_header\n0 0 0 0.5 7 -1 1\n1 0 0 0 0 0 0\n0 1 0 {} 0 0 0\n3 0 1 2\n";
    const Mesh clamped = decode(fmt::format(fmt::runtime(floats), "0"), "a.ply", UpAxis::Y, kAll);
    REQUIRE(clamped.colors.size() == 3);
    CHECK(clamped.colors[0] == vec4(0.5f, 1, 0, 1));
    CHECK(meshFailure(fmt::format(fmt::runtime(floats), "nan"), "a.ply", kAll).find("finite") !=
          std::string::npos);
    CHECK(meshFailure(fmt::format(fmt::runtime(floats), "nan"), "a.ply") == "");
}

TEST_CASE("clean-up: vertices are one only if all that is there of them agrees") {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    CHECK(cleanUp(mesh, "test").vertexCount() == 4);
    Mesh unwrapped = mesh;
    unwrapped.uvs = {{0, 0}, {1, 0}, {0, 1}, {1, -0.0f}, {1, 1}, {0, 0.5f}};
    const Mesh seam = cleanUp(unwrapped, "test");
    CHECK(seam.vertexCount() == 5);
    CHECK(seam.uvs[seam.triangles[1].z] == vec2(0, 0.5f));
    Mesh painted = mesh;
    painted.colors.assign(6, vec4(2));
    painted.colors[3] = vec4(0);
    CHECK(cleanUp(painted, "test").vertexCount() == 5);
    CHECK(cleanUp(painted, "test").colors[0] == vec4(1));
    unwrapped.uvs.pop_back();
    CHECK(cleanUp(unwrapped, "test").uvs.empty());
    unwrapped.uvs.push_back(vec2(0, std::numeric_limits<float>::infinity()));
    CHECK_THROWS_AS(cleanUp(unwrapped, "test"), Error);
}

TEST_CASE("polygons: areas add up and no triangle is turned over") {
    const std::vector<std::vector<vec3>> polygons = {
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
        {{0, 0, 0}, {2, 0, 0}, {0.2f, 0.2f, 0}, {0, 2, 0}},                                       // a dart
        {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}},                       // an L
        {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}, // a U
        {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}}; // a corner on a side
    const double areas[] = {1, 0.4, 5, 8, 4};
    for (size_t i = 0; i < polygons.size(); i++)
        for (int turns = 0; turns < 3; turns++) {
            std::vector<vec3> corners = polygons[i];
            for (vec3& c : corners)
                for (int turn = 0; turn < turns; turn++) c = {c.z, c.x, c.y};
            vec3 front(0, 0, 1);
            for (int turn = 0; turn < turns; turn++) front = {front.z, front.x, front.y};
            std::vector<uvec3> triangles;
            triangulate(corners, triangles, "test");
            CHECK(triangles.size() == corners.size() - 2);
            double sum = 0;
            for (const uvec3& t : triangles) {
                const vec3 cross = glm::cross(corners[t.y] - corners[t.x], corners[t.z] - corners[t.x]);
                CHECK(glm::dot(cross, front) >= 0);
                sum += 0.5 * glm::length(cross);
            }
            CHECK(sum == doctest::Approx(areas[i]));
        }
}

TEST_CASE("polygons: large convex faces pass, large concave ones are refused") {
    std::string round, star, face = "f";
    for (int i = 0; i < 200; i++) {
        const float angle = 2 * kPi * float(i) / 200, reach = i % 2 ? 1.0f : 0.5f;
        round += fmt::format("v {} {} 0\n", std::cos(angle), std::sin(angle));
        star += fmt::format("v {} {} 0\n", reach * std::cos(angle), reach * std::sin(angle));
        face += fmt::format(" {}", i + 1);
    }
    CHECK(decode(round + face, "a.obj").triangleCount() == 198);
    CHECK(meshFailure(star + face, "a.obj").find("concave") != std::string::npos);
    CHECK(meshFailure(star + face + face.substr(1), "a.obj").find("corners") != std::string::npos);
}

TEST_CASE("OBJ: errors name the line, and nothing but the surface is read") {
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    CHECK(meshFailure("", "a.obj").find("no triangles") != std::string::npos);
    CHECK(meshFailure(corners, "a.obj").find("no triangles") != std::string::npos);
    CHECK(meshFailure("v 0 0 0\nv 1 nan 0\n", "a.obj").find("line 2") != std::string::npos);
    CHECK(meshFailure("v 0 0 0\r\nv 1 0\r\n", "a.obj").find("line 2") != std::string::npos);
    for (const char* number : {"1e999", "0x1", "1,5", "inf", "++1", ""})
        CHECK(says(meshFailure(fmt::format("v 0 0 {}\n", number), "a.obj"), "line 1: expected three finite"));
    std::string face = "f";
    for (int i = 0; i < 256 + 3; i++) face += " 1"; // the library would count three corners
    CHECK(says(meshFailure(corners + face + "\n", "a.obj"), "line 4: a face has 259 corners"));
    CHECK(meshFailure(corners + "f 1 2 4\n", "a.obj").find("vertex 4") != std::string::npos);
    // Neither cut off nor wrapped, 4294967299 would be 3.
    for (const char* corner : {"-4", "0", "x", "3.7", "3abc", "4294967299", "99999999999999999999", "3/",
                               "3//", "3/1/1/1", "3//0", "3//-2", "+3", "3/x/1", "0x3"}) {
        CAPTURE(corner);
        const std::string failure = meshFailure(corners + "vn 0 0 1\nf 1 2 " + corner + "\n", "a.obj");
        CHECK(failure.find("line 5: expected a corner") != std::string::npos);
        CHECK(failure.find(fmt::format("\"{}\"", corner)) != std::string::npos);
    }
    CHECK(meshFailure(corners + "f 1 2 2147483647\n", "a.obj").find("vertex 2147483647") !=
          std::string::npos);
    CHECK(meshFailure(corners + "f 1//9 2//9 3//9\nvn 0 0 1\n", "a.obj").find("normal 9") !=
          std::string::npos);
    CHECK(meshFailure(corners + "f 1//1 2//1 3//1\n", "a.obj").find("normal 1") != std::string::npos);
    CHECK(meshFailure(corners + "vn 0 0 1\nf 1//1 2//7 3\n", "a.obj").find("normal 7") != std::string::npos);
    CHECK(meshFailure("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "a.obj").find("degenerate") !=
          std::string::npos);
    CHECK(meshFailure("v 0 0 0\nv 1e30 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj").find("within") !=
          std::string::npos);
    CHECK(says(meshFailure("v 0 0 0\nv 1e-12 0 0\nv 0 1e-12 0\nf 1 2 3\n", "a.obj"), "units across"));
    // Subdivision tags claim any amount of memory, material libraries name other files.
    const std::string hostile = "t x 2000000000/2000000000/2000000000\rvw 0 1\nmtllib /dev/zero\nusemtl a\n";
    CHECK(decode(hostile + corners + hostile + "f 1 2 3\n" + hostile, "a.obj").triangleCount() == 1);
}

TEST_CASE("OBJ: byte order marks, comments behind the data, and lines that go on") {
    const Mesh mesh =
        decode("\xef\xbb\xbfv 0 0 0 # the origin\r\nv 1 0 \\\r\n 0\nv 0 \\\n1 \\\n0\n# C:\\meshes\\\n"
               "v 1 1 0\no a\\\nf 1 2 \\\n 3 # one\nf 3\\\n 2 4\n",
               "a.obj");
    CHECK(mesh.vertexCount() == 4);
    CHECK(mesh.triangleCount() == 2);
    CHECK(meshFailure("v 0 0 \\\n0\nv 1 \\\nx 0\n", "a.obj").find("line 3") != std::string::npos);
    CHECK(meshFailure("v 0 0 \\", "a.obj").find("line 1") != std::string::npos);
}

TEST_CASE("PLY: foreign elements, properties and types are skipped or converted") {
    const Mesh mesh = decode("ply\nformat ascii 1.0\ncomment made by hand\nobj_info none\nelement camera 2\n"
                             "property list uchar float view\nelement face 1\nproperty uchar red\n"
                             "property list uint8 int32 vertex_indices\nelement vertex 4\nproperty double y\n"
                             "property float32 x\nproperty uchar red\nproperty short z\nend_header\n"
                             "2 0.5 1\n0\n255 4 0 1 2 3\n0 0 9 0\n0 1 9 0\n1 1 9 0\n1 0 9 0\n",
                             "a.ply");
    CHECK(mesh.vertexCount() == 4);
    CHECK(mesh.triangleCount() == 2);
    CHECK(mesh.normals[0] == vec3(0, 0, 1));
}

TEST_CASE("PLY: counts and indices that are not true") {
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
        "property float z\nelement face {}\nproperty list uchar int vertex_indices\n"
        "end_header\n0 0 0\n1 0 0\n0 1 0\n{}\n";
    const auto fileOf = [&](const char* vertices, const char* faces, const char* row) {
        return fmt::format(fmt::runtime(header), vertices, faces, row);
    };
    CHECK(meshFailure(fileOf("3", "1", "3 0 1 2"), "a.ply") == "");
    CHECK(meshFailure(fileOf("3000000000000", "1", "3 0 1 2"), "a.ply").find("truncated") !=
          std::string::npos);
    CHECK(meshFailure(fileOf("99999999999999999999", "1", "3 0 1 2"), "a.ply").find("header") !=
          std::string::npos);
    CHECK(meshFailure(fileOf("-3", "1", "3 0 1 2"), "a.ply").find("header") != std::string::npos);
    CHECK(meshFailure(fileOf("3", "4000000000", "3 0 1 2"), "a.ply").find("truncated") != std::string::npos);
    CHECK(meshFailure(fileOf("3", "1", "3 0 1 3"), "a.ply").find("vertex 3") != std::string::npos);
    CHECK(meshFailure(fileOf("3", "1", "3 0 1 -1"), "a.ply").find("corrupt") != std::string::npos);
    CHECK(meshFailure(fileOf("3", "1", "2000000000 0 1 2"), "a.ply").find("claims") != std::string::npos);
    CHECK(meshFailure(fileOf("3", "1", "3 0 1"), "a.ply").find("truncated") != std::string::npos);
    CHECK(meshFailure(fileOf("3", "1", "3 0 1 x"), "a.ply").find("number") != std::string::npos);
    for (const char* row : {"3 0 1 2abc", "3 0 1 1e999"})
        CHECK(meshFailure(fileOf("3", "1", row), "a.ply").find("number") != std::string::npos);
    CHECK(says(meshFailure(fileOf("3", "1x", "3 0 1 2"), "a.ply"), "header"));
    CHECK(says(
        meshFailure("ply\nformat ascii 1.0\nelement junk 5\n" +
                        fileOf("3", "1", "3 0 1 2").substr(std::string("ply\nformat ascii 1.0\n").size()),
                    "a.ply"),
        "no properties"));
    CHECK(meshFailure("ply\nformat ascii 1.0\nelement vertex 3\n", "a.ply").find("end_header") !=
          std::string::npos);
    CHECK(meshFailure("plum\n", "a.ply").find("PLY") != std::string::npos);
    const std::string good = fileOf("3", "1", "3 0 1 2"), format = "format ascii 1.0\n";
    CHECK(meshFailure("ply\n" + good.substr(4 + format.size()), "a.ply").find("no format") !=
          std::string::npos);
    CHECK(meshFailure("ply\nformat ascii 2.0\n" + good.substr(4 + format.size()), "a.ply")
              .find("version 2.0") != std::string::npos);
    for (const char* line :
         {"format ascii", "format text 1.0", "element edge", "element edge 1 2", "elements edge 1",
          "property", "property float", "property real z", "property list uchar int",
          "property list float int z", "property list uchar whole z"})
        CHECK(says(meshFailure("ply\n" + format + "element face 1\n" + line + "\nend_header\n", "a.ply"),
                   "header line"));
    CHECK(says(meshFailure("ply\n" + format + "property float x\nend_header\n", "a.ply"), "header line 3"));
    std::string comments = "ply\n" + format;
    for (int i = 0; i < 1000; i++) comments += "comment\n";
    CHECK(meshFailure(comments + good.substr(4 + format.size()), "a.ply").find("more than 1000 lines") !=
          std::string::npos);
}

TEST_CASE("glTF: node transforms apply, and mirrors keep the outside out") {
    Mesh sphere = makeSphere(1);
    const Mesh moved = decode(sampleGlb(sphere, R"({"children":[1],"translation":[1,2,3]},
        {"mesh":0,"scale":[2,2,-2],"rotation":[0,0.70710678,0,0.70710678]})"),
                              "a.glb");
    CHECK(moved.vertexCount() == sphere.vertexCount());
    for (const uvec3& t : moved.triangles) {
        const vec3 center(1, 2, 3), a = moved.positions[t.x], b = moved.positions[t.y],
                                    c = moved.positions[t.z];
        CHECK(glm::dot(glm::cross(b - a, c - a), a - center) > 0);
        CHECK(glm::distance(a, center) == doctest::Approx(2).epsilon(1e-5));
        CHECK(glm::distance(moved.normals[t.x], (a - center) / 2.0f) < 1e-5f);
    }
    // +X turns to -Z (a quarter about Y), after the mirror left it alone.
    CHECK(glm::distance(moved.positions[0],
                        vec3(1, 2, 3) + 2.0f * vec3(-sphere.positions[0].z, sphere.positions[0].y,
                                                    -sphere.positions[0].x)) < 1e-5f);
}

TEST_CASE("glTF: documents that lie") {
    const Mesh sphere = makeSphere(1);
    const auto failsWith = [&](const char* nodes) { return meshFailure(sampleGlb(sphere, nodes), "a.glb"); };
    CHECK(failsWith(R"({"mesh":0})") == "");
    CHECK(failsWith(R"({"mesh":7})").find("mesh 7") != std::string::npos);
    CHECK(failsWith(R"({"children":[0]})").find("tree") != std::string::npos);
    CHECK(failsWith(R"({"children":[9]})").find("node 9") != std::string::npos);
    CHECK(failsWith(R"({"mesh":0,"scale":[1,2]})").find("expected 3") != std::string::npos);
    CHECK(failsWith(R"({"mesh":0,"scale":[0,0,0]})").find("degenerate") != std::string::npos);
    CHECK(failsWith(R"({"mesh":0,"translation":[1e300,0,0]})").find("finite") != std::string::npos);
    CHECK(meshFailure("{", "a.gltf").find("not valid") != std::string::npos);
    CHECK(meshFailure("[]", "a.gltf") != "");
    CHECK(meshFailure(std::string(100000, '['), "a.gltf").find("deeper") != std::string::npos);
    CHECK(meshFailure(R"({"asset":{"version":"2.0"}})", "a.gltf").find("no triangles") != std::string::npos);
    CHECK(meshFailure(R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"]})",
                      "a.gltf")
              .find("KHR_draco") != std::string::npos);
    const auto changed = [&](const std::string& from, const std::string& to) {
        return meshFailure(sampleGlb(sphere, R"({"mesh":0})", from, to), "a.glb");
    };
    CHECK(changed("\"count\":240", "\"count\":241").find("does not fit") != std::string::npos);
    CHECK(changed("\"count\":240", "\"count\":99999999999999").find("does not fit") != std::string::npos);
    CHECK(changed("\"byteOffset\":0", "\"byteOffset\":18446744073709551000").find("a.glb") !=
          std::string::npos);
    CHECK(changed("\"bufferView\":0", "\"bufferView\":12").find("a.glb") != std::string::npos);
    // Values that the library would replace by defaults, or wrap.
    for (const auto& [from, key, value] : {std::tuple("\"buffer\":0", "buffer", "-3"),
                                           {"\"byteOffset\":0", "byteOffset", "-4"},
                                           {"\"bufferView\":0", "bufferView", "\"0\""},
                                           {"\"indices\":2", "indices", "4294967298"},
                                           {"\"indices\":2", "indices", "2.5"},
                                           {"\"mesh\":0", "mesh", "4294967296"},
                                           {"\"nodes\":[0]", "nodes", "[0.5]"},
                                           {"\"scene\":0", "scene", "-1"}}) {
        const std::string failure = changed(from, fmt::format("\"{}\":{}", key, value));
        CAPTURE(failure);
        CHECK(failure.find(fmt::format("\"{}\": expected a whole number", key)) != std::string::npos);
    }
    CHECK(changed("\"NORMAL\":1", "\"NORMAL\":-1").find("whole number") != std::string::npos);
    CHECK(changed("\"indices\":2", "\"indices\":2,\"mode\":99").find("mode 99") != std::string::npos);
    CHECK(changed("\"version\":\"2.0\"", "\"version\":\"1.0\"").find("found \"1.0\"") != std::string::npos);
    CHECK(changed("\"version\":\"2.0\"", "\"version\":2.0").find("version 2.0") != std::string::npos);
    const std::string normals = R"("bufferView":1,"componentType":5126,"count":42)";
    CHECK(changed(normals, normals.substr(0, normals.size() - 1) + "1").find("NORMAL of 41 vertices") !=
          std::string::npos);
    CHECK(changed("VEC3", "VEC2").find("VEC3") != std::string::npos);
    CHECK(changed("5125", "5126").find("unsigned") != std::string::npos);
}

// No clock is asked: time by the square of the length would be minutes, which nobody overlooks.
TEST_CASE("glTF: chains of nodes and long lists take time by their length, not its square") {
    std::string nodes = R"({"mesh":0,"children":[1]})";
    constexpr int kNodes = 400000;
    for (int i = 1; i < kNodes; i++) nodes += fmt::format(R"(,{{"children":[{}]}})", i + 1);
    CHECK(decode(sampleGlb(makeSphere(0), nodes + ",{}"), "a.glb").triangleCount() == 20);
}

TEST_CASE("glTF: vertex colors of any type, three channels leave the fourth weight 0") {
    const auto colorsOf = [](int type, const char* width, const char* more, const std::string& data) {
        std::string buffer;
        for (const float value : {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}) put(buffer, value);
        const std::string json = fmt::format(
            R"({{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],)"
            R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"COLOR_0":1}}}}]}}],"accessors":[)"
            R"({{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}},)"
            R"({{"bufferView":1,"componentType":{},"count":3,"type":"{}"{}}}],"bufferViews":[)"
            R"({{"buffer":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":{}}}],)"
            R"("buffers":[{{"byteLength":{}}}]}})",
            type, width, more, data.size(), 36 + data.size());
        return decode(glbOf(json, buffer + data), "a.glb", UpAxis::Y, kAll).colors;
    };
    const std::string bytes("\xff\x33\0\0\0\xff\0\0\0\0\xff\xff", 12);
    const std::vector<vec4> four = colorsOf(5121, "VEC4", R"(,"normalized":true)", bytes);
    REQUIRE(four.size() == 3);
    CHECK(glm::distance(four[0], vec4(1, 0.2f, 0, 0)) < 1e-6f);
    CHECK(four[2] == vec4(0, 0, 1, 1));
    std::string floats;
    for (const float value : {0.5f, 0.25f, 2.0f, 0.0f, 0.0f, 0.0f, 1.0f, -1.0f, 0.0f}) put(floats, value);
    const std::vector<vec4> three = colorsOf(5126, "VEC3", "", floats);
    REQUIRE(three.size() == 3);
    CHECK(three[0] == vec4(0.5f, 0.25f, 1, 0));
    CHECK(three[2] == vec4(1, 0, 0, 0));
}

TEST_CASE("glTF: tangents turn with their node, and broken ones give way to the normal's frame") {
    const auto tangentsOf = [](std::initializer_list<float> tangents) {
        std::string buffer;
        for (const float value : {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}) put(buffer, value);
        for (const float value : tangents) put(buffer, value);
        // A turn by 90 degrees about Y takes X to -Z, and the triangle's normal Z to X.
        const std::string json = fmt::format(
            R"({{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0,"rotation":[0,0.70710678,0,0.70710678]}}],)"
            R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TANGENT":1}}}}]}}],"accessors":[)"
            R"({{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}},)"
            R"({{"bufferView":1,"componentType":5126,"count":3,"type":"VEC4"}}],"bufferViews":[)"
            R"({{"buffer":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":48}}],)"
            R"("buffers":[{{"byteLength":{}}}]}})",
            buffer.size());
        return decode(glbOf(json, buffer), "a.glb", UpAxis::Y, {}).tangents;
    };
    // Of any length, not quite orthogonal to the normal, and none at all.
    const std::vector<vec3> tangents = tangentsOf({2, 0, 0, 1, 0, 1, 1, -1, 0, 0, 0, 1});
    REQUIRE(tangents.size() == 3);
    CHECK(glm::distance(tangents[0], vec3(0, 0, -1)) < 1e-6f);
    CHECK(glm::distance(tangents[1], vec3(0, 1, 0)) < 1e-6f);
    CHECK(glm::distance(tangents[2], tangentFrame({1, 0, 0}).s) < 1e-6f);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK(tangentsOf({0, 0, 0, 1, nan, 0, 0, 1, 0, 0, 0, 1}).empty());
}

TEST_CASE("glTF: buffers come from the file's own folder only") {
    const TemporaryFolder folder;
    const Mesh sphere = makeSphere(1);
    std::filesystem::create_directory(folder.path() / "inner");
    folder.write("inner/data.bin", sampleBuffer(sphere));
    folder.write("outside.bin", sampleBuffer(sphere));
    checkSame(readMesh(folder.write("inner/good.gltf", sampleGltf(sphere, "data.bin"))), sphere);
    std::filesystem::create_symlink("data.bin", folder.path() / "inner/inside.bin");
    std::filesystem::create_symlink("../outside.bin", folder.path() / "inner/link.bin");
    checkSame(readMesh(folder.write("inner/good.gltf", sampleGltf(sphere, "inside.bin"))), sphere);
    for (const std::string& uri : {std::string("../outside.bin"), (folder.path() / "outside.bin").string(),
                                   std::string("missing.bin"), std::string("link.bin")})
        CHECK_THROWS_WITH_AS(readMesh(folder.write("inner/bad.gltf", sampleGltf(sphere, uri))),
                             doctest::Contains("no file in its folder or below"), Error);
    folder.write("inner/short.bin", sampleBuffer(sphere).substr(1));
    CHECK_THROWS_WITH_AS(readMesh(folder.write("inner/bad.gltf", sampleGltf(sphere, "short.bin"))),
                         doctest::Contains("buffers[0]: expected 1968 bytes by its byteLength, found 1967"),
                         Error);
    const std::string data = "data:application/octet-stream;base64,";
    checkSame(readMesh(folder.write("inner/good.gltf",
                                    sampleGltf(sphere, data + encodeBase64(sampleBuffer(sphere))))),
              sphere);
    const std::string echo =
        meshFailure(sampleGltf(sphere, data + encodeBase64(sampleBuffer(sphere) + "x")), "a.gltf");
    CHECK(echo.find("found 1969") != std::string::npos);
    CHECK(echo.find("base64") == std::string::npos);
    CHECK_THROWS_AS(readMesh(folder.path() / "missing.obj"), Error);
    CHECK_THROWS_AS(readMesh(folder.write("mesh.stl", "solid")), Error);
}

TEST_CASE("mesh files: truncated anywhere or with any bit flipped, a mesh or an Error") {
    const Mesh sphere = makeSphere(0);
    const std::pair<std::string, std::string> files[] = {
        {sampleObj(sphere), "a.obj"},
        {samplePly(sphere, PlySample::Ascii), "a.ply"},
        {samplePly(sphere, PlySample::LittleEndian), "b.ply"},
        {sampleGlb(sphere), "a.glb"}};
    std::mt19937 random(7);
    for (const auto& [bytes, name] : files) {
        for (size_t size = 0; size < bytes.size(); size += 3) meshFailure(bytes.substr(0, size), name);
        for (int i = 0; i < 1000; i++) {
            std::string damaged = bytes;
            for (int flips = 1 + i % 3; flips > 0; flips--)
                damaged[random() % damaged.size()] ^= char(1u << (random() % 8));
            meshFailure(damaged, name);
        }
        CHECK(meshFailure(bytes, name) == "");
    }
}
