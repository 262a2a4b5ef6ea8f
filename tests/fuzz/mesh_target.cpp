// Readers of meshes without materials. The first byte of an input chooses the format.
#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/import/builtin_mesh.h"
#include "engine/import/mesh_file.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/mesh_samples.h"

#include <cmath>

namespace relume::test {

namespace {

constexpr const char* kNames[] = {"fuzz/a.obj", "fuzz/a.ply", "fuzz/a.gltf", "fuzz/a.glb"};

void run(std::span<const std::byte> input) {
    if (input.empty()) return;
    try {
        const Mesh mesh = decodeMesh(input.subspan(1), kNames[size_t(input[0]) % std::size(kNames)],
                                     UpAxis::Y, {true, true});
        RELUME_CHECK(!mesh.triangles.empty());
        RELUME_CHECK_EQ(mesh.normals.size(), mesh.positions.size());
        for (const vec3& position : mesh.positions)
            for (int axis = 0; axis < 3; axis++) RELUME_CHECK(std::isfinite(position[axis]));
        for (const uvec3& triangle : mesh.triangles)
            for (int corner = 0; corner < 3; corner++) RELUME_CHECK(triangle[corner] < mesh.vertexCount());
    } catch (const Error&) {
    }
}

std::vector<Bytes> seeds() {
    const Mesh mesh = makeSphere(0);
    return {seedOf({0}, sampleObj(mesh)),
            seedOf({0}, "v 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nf 1/1 2/2 3/1 -1/2\n"),
            seedOf({1}, samplePly(mesh, PlySample::Ascii)),
            seedOf({1}, samplePly(mesh, PlySample::LittleEndian)),
            seedOf({1}, samplePly(mesh, PlySample::BigEndian)),
            seedOf({3}, sampleGlb(mesh))};
}

const AddFuzzTarget kAdded({"mesh", run, seeds});

} // namespace
} // namespace relume::test
