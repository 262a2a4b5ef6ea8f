// The reader of glTF files with materials and textures. The first byte of an input chooses how deep it
// strikes: 0: the rest is a file; 1: the JSON of a binary file whose buffer is as in the sample; 2: edits of
// that buffer.
#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/import/mesh_formats.h"
#include "precompute/brdf/material_list.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/fuzz_edits.h"
#include "tests/support/packed_glb.h"
#include "tests/support/textured_glb.h"

#include <cmath>

namespace relume::test {

namespace {

enum Depth { kRaw, kJson, kBuffer, kDepths };

// All that materials have: maps of color, normals, metalness and emission, colors of vertices, transformed
// placement, extensions.
TexturedGlb sample() {
    TexturedGlb glb;
    glb.primitives = R"([{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2,"COLOR_0":1},"indices":3,
        "material":0},{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":4,"material":1}])";
    glb.materials = R"([{"name":"tin","normalTexture":{"index":1,"scale":0.5},"emissiveFactor":[1,0.5,0],
        "emissiveTexture":{"index":0},"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4},
        "KHR_materials_sheen":{"sheenColorFactor":[1,0.5,0],"sheenRoughnessFactor":0.5},
        "KHR_materials_anisotropy":{"anisotropyStrength":0.5,"anisotropyRotation":1}},
        "pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,1],"metallicFactor":0.9,"roughnessFactor":0.75,
        "baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":0}}},
        {"alphaMode":"BLEND","occlusionTexture":{"index":0},"extensions":{"KHR_materials_ior":{"ior":1.5},
        "KHR_materials_specular":{"specularFactor":0.5,"specularColorFactor":[1,1,1]},
        "KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatTexture":{"index":0}}},"pbrMetallicRoughness":{"baseColorTexture":{"index":1,
        "texCoord":0,"extensions":{"KHR_texture_transform":{"offset":[0.5,0],"scale":[2,1],"rotation":1}}}}}])";
    return glb;
}

void checkPart(const GltfPart& part) {
    RELUME_CHECK(!part.mesh.triangles.empty());
    for (const vec3& position : part.mesh.positions)
        for (int axis = 0; axis < 3; axis++) RELUME_CHECK(std::isfinite(position[axis]));
    for (const vec2& uv : part.mesh.uvs) RELUME_CHECK(std::isfinite(uv.x) && std::isfinite(uv.y));
    for (const auto* texture :
         {&part.baseColor, &part.materialMap, &part.detail.normalMap, &part.detail.emissionMap})
        if (*texture) RELUME_CHECK_EQ(part.mesh.uvs.size(), part.mesh.positions.size());
    readMaterials(part.material); // it can be baked: an exception here is a finding
}

void run(std::span<const std::byte> input) {
    static const TexturedGlb::Content whole = sample().content();
    const int depth = input.empty() ? kRaw : int(input[0]) % kDepths;
    const auto rest = input.subspan(std::min<size_t>(input.size(), 1));
    std::string file(textOf(rest));
    if (depth == kJson) file = glbOf(file, whole.buffer);
    if (depth == kBuffer) {
        const auto bytes = std::as_bytes(std::span(whole.buffer));
        const Bytes edited = editedBytes({bytes.begin(), bytes.end()}, ByteReader(rest, "edits"));
        file = glbOf(whole.json, std::string(textOf(edited)));
    }
    GltfParts parts;
    try {
        parts = decodeGltfParts(std::as_bytes(std::span(file)), "fuzz", "fuzz/a.glb");
    } catch (const Error&) {
        return;
    }
    for (const GltfPart& part : parts.parts) checkPart(part);
}

std::vector<Bytes> seeds() {
    const std::string edit = std::string("\x01\x00\x10\0\xff\xff\xff\xff", 8);
    return {seedOf({kRaw}, sample().bytes()), seedOf({kRaw}, PackedGlb().bytes()),
            seedOf({kJson}, sample().content().json), seedOf({kBuffer}, edit)};
}

// As textures, of which a file may have as many as its bytes allow.
const AddFuzzTarget kAdded({"gltf", run, seeds, uint64_t(512) << 20, 512 * 16});

} // namespace
} // namespace relume::test
