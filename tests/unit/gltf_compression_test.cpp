// glTF files that EXT_meshopt_compression packs, by meshoptimizer's own encoders.
#include "engine/base/error.h"
#include "engine/import/mesh_formats.h"
#include "tests/support/failure.h"
#include "tests/support/packed_glb.h"

#include <doctest/doctest.h>
#include <functional>
#include <random>

using namespace relume;
using namespace relume::test;

namespace {

using Json = nlohmann::json;

std::string unpackFailure(const PackedGlb& glb) {
    return failureOf([&] { decodeGlb(glb.bytes()); });
}

// The error that a change of the description of view 0 causes.
std::string failureWith(const char* key, const Json& value) {
    PackedGlb glb;
    glb.description(0)[key] = value;
    return unpackFailure(glb);
}

} // namespace

TEST_CASE("glTF compression: what is packed is what the plain file has") {
    const std::vector<GltfPart> plain = decodeGlb(TexturedGlb().bytes()).parts;
    for (const char* mode : {"TRIANGLES", "INDICES"}) {
        CAPTURE(mode);
        const std::vector<GltfPart> parts = decodeGlb(PackedGlb(mode).bytes()).parts;
        REQUIRE(parts.size() == plain.size());
        for (size_t i = 0; i < parts.size(); i++) {
            const Mesh &mesh = parts[i].mesh, &expected = plain[i].mesh;
            CHECK(mesh.positions == expected.positions);
            CHECK(mesh.uvs == expected.uvs);
            CHECK(mesh.triangles == expected.triangles);
            REQUIRE(mesh.normals.size() == expected.normals.size());
            for (const vec3& normal : mesh.normals) CHECK(glm::distance(normal, vec3(0.6f, 0, 0.8f)) < 0.01f);
            CHECK(parts[i].baseColor->texels == plain[i].baseColor->texels); // images are not packed
        }
        // (.6, .8, 0), made orthogonal to the normal.
        REQUIRE(!parts[0].mesh.tangents.empty());
        const vec3 expected = glm::normalize(vec3(0.6f, 0.8f, 0) - 0.36f * vec3(0.6f, 0, 0.8f));
        for (const vec3& tangent : parts[0].mesh.tangents) CHECK(glm::distance(tangent, expected) < 0.01f);
    }
}

TEST_CASE("glTF compression: a buffer that stands for others needs neither tag nor bytes, and gives none") {
    PackedGlb glb;
    glb.json["buffers"][1].erase("extensions");
    CHECK(unpackFailure(glb) == "");
    glb.json["buffers"][1]["byteLength"] = size_t(1) << 40; // nobody allocates it
    CHECK(unpackFailure(glb) == "");
    glb.json["bufferViews"][2].erase("extensions");
    CHECK(says(unpackFailure(glb), "truncated or corrupt"));
    glb.json["bufferViews"][2].erase("byteStride");
    glb.description(1)["buffer"] = 1;
    CHECK(says(unpackFailure(glb), "does not fit in its buffer of 1 bytes"));
}

TEST_CASE("glTF compression: descriptions that lie") {
    CHECK(failureWith("byteStride", 12) == "");
    CHECK(says(failureWith("byteStride", 13), "bufferViews[0]"));
    CHECK(says(failureWith("byteStride", 0), "stride 0"));
    CHECK(says(failureWith("byteStride", 260), "stride 260"));
    CHECK(says(failureWith("byteStride", -4), "byteStride"));
    CHECK(says(failureWith("byteStride", 24), "cannot be unpacked"));
    CHECK(says(failureWith("count", 0), "count 0"));
    CHECK(says(failureWith("count", 1e9), "count"));
    CHECK(says(failureWith("count", 100'000'000), "times the file's bytes"));
    CHECK(says(failureWith("count", ~uint64_t(0)), "times the file's bytes"));
    CHECK(says(failureWith("buffer", 2), "there are only 2"));
    CHECK(says(failureWith("buffer", "0"), "\"buffer\""));
    CHECK(says(failureWith("byteLength", 1 << 20), "does not fit"));
    CHECK(says(failureWith("byteOffset", ~uint64_t(0)), "does not fit"));
    CHECK(says(failureWith("byteLength", 20), "cannot be unpacked"));
    CHECK(says(failureWith("byteLength", 0), "cannot be unpacked"));
    CHECK(says(failureWith("mode", "TRIANGLES"), "mode \"TRIANGLES\""));
    CHECK(says(failureWith("mode", 7), "\"mode\""));
    CHECK(says(failureWith("filter", "QUATERNION"), "filter \"QUATERNION\""));
    CHECK(says(failureWith("filter", "OCTAHEDRAL"), "filter \"OCTAHEDRAL\""));
    CHECK(says(failureWith("filter", "COLOR"), "filter \"COLOR\""));
    PackedGlb glb;
    glb.description(0) = 7;
    CHECK(says(unpackFailure(glb), "expected an object"));
    glb = PackedGlb();
    glb.description(3)["count"] = 11; // no whole triangles
    CHECK(says(unpackFailure(glb), "count 11"));
    glb = PackedGlb();
    glb.description(3)["byteStride"] = 8;
    CHECK(says(unpackFailure(glb), "stride 8"));
    glb = PackedGlb();
    glb.description(3)["filter"] = "EXPONENTIAL"; // filters are for attributes
    CHECK(says(unpackFailure(glb), "filter \"EXPONENTIAL\""));
    glb = PackedGlb();
    glb.description(0)["count"] = 3; // fewer than its accessor has
    CHECK(unpackFailure(glb) != "");
}

TEST_CASE("glTF compression: views that share their bytes do not unfold without end") {
    PackedGlb glb;
    for (int i = 0; i < 2000; i++) glb.json["bufferViews"].push_back(glb.json["bufferViews"][0]);
    CHECK(says(unpackFailure(glb), "times the file's bytes"));
}

TEST_CASE("glTF compression: damaged bytes give parts or an Error") {
    const PackedGlb whole;
    const size_t first = PackedGlb().description(0)["byteOffset"];
    std::mt19937 random(5);
    for (int i = 0; i < 1000; i++) {
        PackedGlb damaged = whole;
        for (int flips = 1 + i % 3; flips > 0; flips--) {
            const size_t place = first + random() % (damaged.buffer.size() - first);
            damaged.buffer[place] ^= char(1u << (random() % 8));
        }
        unpackFailure(damaged);
    }
}
