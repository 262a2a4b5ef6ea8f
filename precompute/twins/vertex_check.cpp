#include "precompute/twins/vertex_check.h"
#include "engine/math/haar.h"

#include "engine/base/check.h"

namespace relume {

VertexReference recomputeVertex(const Asset& asset, size_t part, size_t set, size_t vertex,
                                const RayTracer& occluder) {
    RELUME_CHECK_LT(part, asset.parts.size());
    const Mesh& mesh = asset.parts[part].mesh;
    const FactoredBrdf& brdf = asset.parts[part].sets.at(set).brdf;
    RELUME_CHECK_LT(vertex, mesh.vertexCount());
    const vec3 normal = mesh.normals[vertex];
    const vec3 origin = mesh.positions[vertex] + asset.visibilityOffset * normal;

    VertexReference reference;
    reference.visibility = visibilityCube(occluder, origin, normal, asset.visibilitySize);
    for (int k = 0; k < brdf.terms; k++) {
        TermReference term;
        term.transport = transportVector(reference.visibility, asset.visibilitySize, asset.faceSize,
                                         asset.transportSamples, brdf, k, frameOf(mesh, vertex));
        term.coefficients = term.transport;
        haarForwardFaces(term.coefficients, asset.faceSize);
        term.selected = selectLargest(term.coefficients, asset.coefficients);
        term.row = packRow(term.coefficients, term.selected);
        reference.terms.push_back(std::move(term));
    }
    return reference;
}

PackedRow storedRow(const SparseTransport& transport, size_t vertex, size_t term) {
    const size_t row = vertex * transport.terms + term;
    RELUME_CHECK_LT(row, transport.rows());
    const auto first = std::ptrdiff_t(transport.rowStarts[row]),
               last = std::ptrdiff_t(transport.rowStarts[row + 1]);
    return {transport.scales[row],
            {transport.indices.begin() + first, transport.indices.begin() + last},
            {transport.values.begin() + first, transport.values.begin() + last}};
}

} // namespace relume
