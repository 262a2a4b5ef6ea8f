// Tests glTF documents that refer to what is not there.
#include "engine/import/mesh_file.h"
#include "tests/support/capture_binding.h"
#include "tests/support/failure.h"
#include "tests/support/mesh_samples.h"

#include <doctest/doctest.h>

using namespace relume;
using namespace relume::test;

namespace {

std::string gltfFailure(const std::string& text, const std::string& name) {
    return failureOf([&] { decodeMesh(std::as_bytes(std::span(text)), name, UpAxis::Y, {true, true}); });
}

} // namespace

// A triangle, whose document and 44 bytes of buffer are as a test has it: three positions, then three
// indices.
TEST_CASE("glTF: references beyond what there is, and views that do not hold what they should") {
    const std::string buffer = std::string(12, '\0') + std::string("\0\0\x80?\0\0\0\0\0\0\0\0", 12) +
                               std::string("\0\0\0\0\0\0\x80?\0\0\0\0", 12) +
                               std::string("\0\0\1\0\2\0\0\0", 8);
    const std::string whole =
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
            "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
            "accessors":[{"bufferView":0,"byteOffset":0,"componentType":5126,"count":3,"type":"VEC3"},
                         {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
            "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":8}],
            "buffers":[{"byteLength":44}]})";
    const auto fails = [&](const std::string& from, const std::string& to) {
        std::string json = whole;
        const size_t place = json.find(from);
        REQUIRE(place != std::string::npos);
        return gltfFailure(glbOf(json.replace(place, from.size(), to), buffer), "a.glb");
    };
    REQUIRE(fails("3", "3") == "");
    struct Lie {
        const char *from, *to, *said;
    };
    for (
        const auto& [from, to, said] : std::initializer_list<Lie>{
            {R"("byteOffset":0,"componentType")", R"("byteOffset":1000000000000,"componentType")",
             "does not fit in its buffer view"},
            {R"("byteOffset":0,"byteLength":36)", R"("byteOffset":0,"byteStride":4,"byteLength":36)",
             "does not fit in its buffer view"},
            {R"("byteLength":36)", R"("byteLength":8)", "does not fit in its buffer view"},
            {R"("byteLength":36)", R"("byteLength":1000000000)", "does not fit in its buffer of 44 bytes"},
            {"5126", "5127", "does not fit in its buffer view"},
            {"5126", "5125", "component type 5125"},
            {R"("count":3,"type":"VEC3")",
             R"("count":3,"sparse":{"count":1,"indices":{"bufferView":1,"componentType":5123},"values":{"bufferView":0}},"type":"VEC3")",
             "is sparse"},
            {R"("POSITION":0)", R"("POSITION":90000000)", "refers to accessor 90000000"},
            {R"({"POSITION":0})", "{}", "holds no triangles"},
            {R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}])",
             R"("nodes":[{"children":[700000000]}])", "refers to node 700000000"},
            {R"("scene":0)", R"("scene":500000000)", "default scene"},
            {R"("indices":1)", R"("indices":1,"mode":0)", "holds no triangles"},
            {R"("asset":{"version":"2.0"})", R"("asset":5)", "asset version 2.0"},
            {R"([{"byteLength":44}])", "[5]", "is not valid glTF"},
            {R"("byteLength":44)", R"("byteLength":44,"uri":5)", "buffers[0]: \"uri\""},
            {R"({"buffer":0,"byteOffset":0,)", R"({"byteOffset":0,)", "is not valid glTF"},
            {R"("POSITION":0})", R"("POSITION":0,"TEXCOORD_0":0})", "expected VEC2"}}) {
        const std::string failure = fails(from, to);
        CAPTURE_BINDING(to);
        CAPTURE(failure);
        CHECK(says(failure, said));
    }
    // A quotation mark in a name does not end the count of levels.
    const std::string deep = R"({"a\"":)" + std::string(200'000, '[') + std::string(200'000, ']') + "}";
    CHECK(says(gltfFailure(deep, "a.gltf"), "nested deeper"));
}
