#include "precompute/bake/content_hash.h"

namespace relume {

std::string visibilityKey(const Asset& asset, VisibilityMethod method) {
    ContentHash hash;
    hash.add(visibilityMethodName(method));
    hash.add(asset.provenance.device);
    for (const auto kernel : visibilityKernels(method)) hash.add(kernel);
    const auto size = uint32_t(asset.visibilitySize);
    const float lifted[] = {asset.visibilityOffset, visibilityNearDistance(asset.visibilityOffset)};
    hash.add(std::span(&size, 1));
    hash.add(std::span<const float>(lifted));
    hash.add(std::span(asset.occluder.positions));
    hash.add(std::span(asset.occluder.triangles));
    for (const AssetPart& part : asset.parts) {
        hash.add(std::span(part.mesh.positions));
        hash.add(std::span(part.mesh.normals));
    }
    return hash.text();
}

} // namespace relume
