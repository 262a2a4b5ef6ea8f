#include "engine/scene/scene.h"

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/scene/builtin_mesh.h"
#include "engine/scene/mesh_file.h"

namespace relume {
namespace {

// About 10,000 vertices each, about two units across.
Mesh makeBuiltin(const std::string& name) {
    if (name == "sphere") return makeSphere(5);
    if (name == "torus") return makeTorus(0.7f, 0.3f, 160, 64);
    if (name == "knot") return makeKnot();
    RELUME_CHECK_EQ(name, "plane");
    return makePlane(2, 100);
}

} // namespace

bool isBuiltinMesh(const std::string& name) {
    return name == "sphere" || name == "torus" || name == "knot" || name == "plane";
}

Bounds boundsOf(const Scene& scene) {
    Bounds bounds;
    for (const Part& part : scene.parts) bounds.add(boundsOf(part.mesh));
    return bounds;
}

Part loadPart(const std::string& mesh, UpAxis up, const std::string& material) {
    if (isBuiltinMesh(mesh)) {
        Part part{mesh, makeBuiltin(mesh), material, "built-in " + mesh, ""};
        if (up == UpAxis::Z) turnZUp(part.mesh);
        return part;
    }
    const std::filesystem::path path(mesh);
    const std::vector<std::byte> bytes = readFile(path);
    return {path.stem().string(), decodeMesh(bytes, path, up), material, mesh, hashText(bytes)};
}

void addGround(Scene& scene, const GroundOptions& options, const std::string& material) {
    RELUME_CHECK(!scene.parts.empty());
    if (options.tessellation < 1 || options.tessellation > kMostGroundQuads)
        throw UsageError("a ground of {} quads a side: expected 1 to {}", options.tessellation,
                         kMostGroundQuads);
    if (!(options.extent >= kSmallestGroundExtent && options.extent <= kLargestGroundExtent))
        throw UsageError("a ground {} times as large as the object: expected {} to {}", options.extent,
                         kSmallestGroundExtent, kLargestGroundExtent);
    scene.parts.push_back({"ground", makeGround(boundsOf(scene), options), material, "built-in ground", ""});
}

} // namespace relume
