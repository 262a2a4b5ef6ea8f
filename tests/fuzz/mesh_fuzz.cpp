// Fuzz target of the mesh readers. The first byte of an input chooses the format.
#include "engine/base/error.h"
#include "engine/scene/mesh_file.h"

using namespace relume;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    static const char* const kNames[] = {"fuzz/a.obj", "fuzz/a.ply", "fuzz/a.gltf", "fuzz/a.glb"};
    if (size == 0) return 0;
    try {
        decodeMesh(std::as_bytes(std::span(data + 1, size - 1)), kNames[data[0] % 4], UpAxis::Y);
    } catch (const Error&) {
    }
    return 0;
}
