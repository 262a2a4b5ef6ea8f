#include "precompute/twins/bounce_twin.h"

#include "engine/math/cubemap.h"
#include "engine/render/appearance.h"
#include "precompute/bounce/bounce_gather.h"

namespace relume {

namespace {

// Adds the row of a vertex's term, times `factor`, to `sum`.
void addRow(const SparseTransport& rows, uint32_t vertex, uint32_t term, vec3 factor,
            std::vector<vec3>& sum) {
    const size_t row = size_t(vertex) * rows.terms + term;
    for (uint64_t entry = rows.rowStarts[row]; entry < rows.rowStarts[row + 1]; entry++)
        sum[rows.indices[entry]] +=
            factor * rows.scales[row] * kCoefficientUnit * vec3(unpackCoefficient(rows.values[entry]));
}

// Adds the coefficients of the radiance that leaves a hit against `direction`, times `factor`.
void addOutgoing(const Asset& asset, const Appearance& bound, std::span<const std::vector<vec3>> gains,
                 std::span<const SparseTransport> from, const RayHit& hit, vec3 direction, vec3 factor,
                 std::vector<vec3>& sum) {
    const AssetPart& part = asset.parts[hit.mesh];
    const Mesh& mesh = part.mesh;
    const uvec3 corners = mesh.triangles[hit.triangle];
    vec3 normal(0), tangent(0);
    vec2 uv(0);
    vec4 color(0);
    for (int i = 0; i < 3; i++) {
        normal += hit.weights[i] * mesh.normals[corners[i]];
        if (!mesh.tangents.empty()) tangent += hit.weights[i] * mesh.tangents[corners[i]];
        if (!mesh.uvs.empty()) uv += hit.weights[i] * mesh.uvs[corners[i]];
        if (!mesh.colors.empty()) color += hit.weights[i] * mesh.colors[corners[i]];
    }
    if (glm::dot(normal, normal) < 1e-12f) return; // normals cancel on a fold
    const TangentFrame frame = tangentFrame(glm::normalize(normal), tangent);
    const vec3 outgoing = liftAboveHorizon(frame.toLocal(-direction));
    const size_t set = bound[hit.mesh].set;
    const FactoredBrdf& brdf = part.sets[set].brdf;
    const std::vector<BoundLayer> layers = boundLayers(part, bound[hit.mesh]);
    const std::vector<vec3> shares = layerWeights(part, set, layers, uv, color);
    for (size_t i = 0; i < layers.size(); i++) {
        for (int term = 0; term < brdf.terms; term++) {
            const vec3 view =
                gains[hit.mesh][i] * shares[i] *
                lookupMap(brdf.viewMap(layers[i].layer, term), brdf.size, brdf.mapping, outgoing);
            for (int corner = 0; corner < 3; corner++)
                addRow(from[hit.mesh], corners[corner], uint32_t(term), factor * hit.weights[corner] * view,
                       sum);
        }
    }
}

} // namespace

std::vector<vec3> bouncedVector(const Asset& asset, const Appearance& bound,
                                std::span<const std::vector<vec3>> gains, const RayTracer& tracer,
                                std::span<const SparseTransport> from, size_t part, uint32_t vertex,
                                size_t set, int term, int size) {
    const Mesh& mesh = asset.parts[part].mesh;
    const FactoredBrdf& brdf = asset.parts[part].sets[set].brdf;
    const TangentFrame frame = frameOf(mesh, vertex);
    const vec3 origin = mesh.positions[vertex] + asset.visibilityOffset * mesh.normals[vertex];
    std::vector<vec3> sum(kBounceCoefficients, vec3(0));
    for (int texel = 0; texel < kCubeFaces * size * size; texel++) {
        const int x = texel % size, y = texel / size % size;
        const vec3 direction = cubeTexelDirection(texel / (size * size), x, y, size);
        const vec3 incoming = frame.toLocal(direction);
        if (!(incoming.z > 0)) continue;
        const std::optional<RayHit> hit = tracer.intersect(origin, direction);
        if (!hit || !meetsFront(asset.parts[hit->mesh].mesh, *hit, direction)) continue;
        const vec3 light = lookupMap(brdf.lightMap(term), brdf.size, brdf.mapping, incoming) * incoming.z *
                           cubeTexelSolidAngle(x, y, size);
        addOutgoing(asset, bound, gains, from, *hit, direction, light, sum);
    }
    return sum;
}

} // namespace relume
