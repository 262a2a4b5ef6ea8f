#include "engine/transport/asset.h"

#include "engine/transport/layout_chunks.h"

#include <algorithm>
#include <cmath>

namespace relume {

int termCount(const AssetPart& part) {
    int terms = 0;
    for (const MaterialSet& set : part.sets) terms += set.brdf.terms;
    return terms;
}

int rowEntries(const Asset& asset, const MaterialSet& set) {
    const bool isOneTerm = isCompressed(layoutOf(set.transport)) && set.brdf.terms == 1;
    return std::min((isOneTerm ? kOneTermEntries : 1) * asset.coefficients,
                    6 * asset.faceSize * asset.faceSize);
}

uint64_t rowEntries(const Asset& asset, const AssetPart& part) {
    uint64_t entries = 0;
    for (const MaterialSet& set : part.sets)
        entries += uint64_t(set.brdf.terms) * uint64_t(rowEntries(asset, set));
    return entries;
}

uint64_t vertexCount(const Asset& asset) {
    uint64_t vertices = 0;
    for (const AssetPart& part : asset.parts) vertices += part.mesh.vertexCount();
    return vertices;
}

Bounds boundsOf(const Asset& asset) {
    Bounds bounds;
    for (const AssetPart& part : asset.parts) bounds.add(boundsOf(part.mesh));
    return bounds;
}

Bounds objectBounds(const Asset& asset) {
    Bounds bounds;
    for (const AssetPart& part : asset.parts)
        if (part.name != "ground") bounds.add(boundsOf(part.mesh));
    return bounds.low.x <= bounds.high.x ? bounds : boundsOf(asset);
}

uint32_t blockVertices(const Asset& asset) {
    int terms = 1;
    for (const AssetPart& part : asset.parts)
        for (const MaterialSet& set : part.sets) terms = std::max(terms, set.brdf.terms);
    uint32_t vertices = 1;
    for (const AssetPart& part : asset.parts)
        for (const MaterialSet& set : part.sets)
            vertices = std::max(vertices, std::visit(
                                              [&](const auto& layout) {
                                                  return blockVertices(layout, asset.coefficients, terms);
                                              },
                                              set.transport));
    return vertices;
}

float smallestLampRadius(const Asset& asset) {
    constexpr double kError = 0.05, kDegrees = 8, kLeast = 4;
    const double error = asset.layout ? asset.layout->error : kError;
    return glm::radians(float(std::max(kLeast, kDegrees * std::sqrt(error / kError))));
}

uint32_t visibilityRunVertices(const Asset& asset) {
    return std::min(blockVertices(asset), kMostBlockVertices);
}

} // namespace relume
