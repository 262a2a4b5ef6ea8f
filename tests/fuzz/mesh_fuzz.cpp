// Fuzz target of the readers of meshes and textures. The first byte of an input chooses the format.
#include "engine/base/error.h"
#include "engine/import/mesh_file.h"
#include "engine/import/mesh_formats.h"
#include "engine/import/texture_file.h"

using namespace relume;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    static const char* const kNames[] = {"fuzz/a.obj", "fuzz/a.ply", "fuzz/a.gltf", "fuzz/a.glb"};
    constexpr MeshAttributes kAll{true, true};
    if (size == 0) return 0;
    try {
        const auto bytes = std::as_bytes(std::span(data + 1, size - 1));
        const int format = data[0] % 6;
        if (format < 4)
            decodeMesh(bytes, kNames[format], UpAxis::Y, kAll);
        else if (format == 4)
            decodeGltfParts(bytes, "fuzz", "fuzz/a.glb");
        else
            decodeTexture(bytes, "fuzz/a.png", true);
    } catch (const Error&) {
    }
    return 0;
}
