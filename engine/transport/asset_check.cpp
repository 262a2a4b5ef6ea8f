#include "engine/transport/asset_check.h"

#include "engine/chunk/block_chunk.h"
#include "engine/scene/factored_brdf.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/core.h>
#include <map>

namespace relume {

namespace {

void expectRange(int64_t value, int64_t low, int64_t high, const std::string& where, const char* what) {
    if (value < low || value > high)
        throw Error(fmt::format("{}: expected {} of {} to {}, found {}", where, what, low, high, value));
}

bool isFinite(vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool allFinite(const std::vector<vec3>& values) { return std::ranges::all_of(values, isFinite); }

bool isSquare(int value) {
    const int root = int(std::lround(std::sqrt(double(value))));
    return root * root == value;
}

void checkSettings(const Asset& asset, const std::string& name) {
    expectRange(asset.faceSize, kSmallestFace, kLargestFace, name, "a face size");
    expectRange(asset.visibilitySize, std::max(asset.faceSize, kSmallestVisibility), kLargestVisibility, name,
                "a visibility size");
    expect(std::has_single_bit(unsigned(asset.faceSize)) &&
               std::has_single_bit(unsigned(asset.visibilitySize)),
           name, "face sizes that are powers of two");
    expectRange(asset.coefficients, 1, 6 * asset.faceSize * asset.faceSize, name, "a number of coefficients");
    const int perSide = asset.visibilitySize / asset.faceSize;
    expectRange(asset.transportSamples, 1, perSide * perSide, name, "transport samples");
    expect(isSquare(asset.transportSamples), name, "a square number of transport samples");
    expect(isMagnitude(asset.visibilityOffset) && isMagnitude(asset.quantizationError) &&
               isMagnitude(asset.truncationError),
           name, "an offset and errors that are finite and not negative");
    if (asset.layout) {
        const auto isPositive = [](double value) { return std::isfinite(value) && value > 0; };
        expect(isPositive(asset.layout->wantedBytes.value_or(1)) &&
                   isPositive(asset.layout->wantedError.value_or(1)) && std::isfinite(asset.layout->error) &&
                   asset.layout->error >= 0,
               name, "a layout's error and what was asked of it that are finite and not negative");
    }
    const float share = asset.provenance.bakedShare.value_or(1);
    expect(share >= 0 && share <= 1, name, "a share of baked vertices of 0 to 1");
}

void checkTriangles(const Mesh& mesh, const std::string& where) {
    const size_t count = mesh.vertexCount();
    expect(count <= 0xffffffffu, where, "fewer than 2^32 vertices");
    expect(allFinite(mesh.positions), where, "finite positions");
    expect(std::ranges::all_of(mesh.triangles,
                               [&](uvec3 t) { return t.x < count && t.y < count && t.z < count; }),
           where, "triangles whose corners are vertices of the mesh");
}

void checkMesh(const Mesh& mesh, const std::string& where) {
    expect(!mesh.positions.empty() && !mesh.triangles.empty(), where, "at least one vertex and one triangle");
    checkTriangles(mesh, where);
    expectCount(mesh.normals.size(), mesh.vertexCount(), where, "normals");
    expect(std::ranges::all_of(mesh.normals, [](vec3 n) { return std::abs(glm::dot(n, n) - 1.0f) <= 2e-3f; }),
           where, "normals of length 1 within 0.001");
    if (mesh.tangents.empty()) return;
    expectCount(mesh.tangents.size(), mesh.vertexCount(), where, "tangents");
    for (size_t i = 0; i < mesh.vertexCount(); i++) {
        const vec3 tangent = mesh.tangents[i];
        expect(std::abs(glm::dot(tangent, tangent) - 1.0f) <= 2e-3f &&
                   std::abs(glm::dot(tangent, mesh.normals[i])) <= 1e-3f,
               where, "tangents of length 1, orthogonal to the normals, within 0.001");
    }
}

void checkBrdf(const FactoredBrdf& brdf, const std::string& where) {
    expectRange(brdf.terms, 1, kMostTerms, where, "BRDF terms");
    expectRange(brdf.size, kSmallestMap, kLargestMap, where, "a map size");
    expectRange(brdf.layers, 1, kLargestLayers, where, "layers of view maps");
    expect(brdf.mapping <= DiskMapping::Polar, where, "the orthographic, the polar or the equal-area map");
    const size_t texels = size_t(brdf.terms) * brdf.mapTexels();
    expectCount(brdf.lightMaps.size(), texels, where, "light map texels");
    expectCount(brdf.viewMaps.size(), texels * size_t(brdf.layers), where, "view map texels");
    expectCount(brdf.eigenvalues.size(), size_t(brdf.terms), where, "eigenvalues");
    expect(allFinite(brdf.lightMaps) && allFinite(brdf.viewMaps), where, "finite light and view maps");
    for (const auto& value : brdf.eigenvalues)
        expect(isFinite({value[0], value[1], value[2]}), where, "finite eigenvalues");
}

void checkTexture(const Texture& texture, const Mesh& mesh, const std::string& where) {
    expectRange(texture.width, 1, kLongestTextureSide, where, "a texture's width");
    expectRange(texture.height, 1, kLongestTextureSide, where, "a texture's height");
    expectCount(texture.texels.size(), texture.texelCount(), where, "texels");
    expect(!mesh.uvs.empty(), where, "texture coordinates for its textures");
}

void checkPaint(const AssetPart& part, const std::string& where) {
    const Mesh& mesh = part.mesh;
    if (!mesh.uvs.empty()) expectCount(mesh.uvs.size(), mesh.vertexCount(), where, "texture coordinates");
    if (!mesh.colors.empty()) expectCount(mesh.colors.size(), mesh.vertexCount(), where, "vertex colors");
    expect(std::ranges::all_of(mesh.uvs, [](vec2 uv) { return std::isfinite(uv.x) && std::isfinite(uv.y); }),
           where, "finite texture coordinates");
    expect(std::ranges::all_of(mesh.colors,
                               [](vec4 c) {
                                   return glm::all(glm::greaterThanEqual(c, vec4(0))) &&
                                          glm::all(glm::lessThanEqual(c, vec4(1)));
                               }),
           where, "vertex colors in [0, 1]");
    if (part.baseColor) checkTexture(*part.baseColor, mesh, where);
    if (part.materialMap) checkTexture(*part.materialMap, mesh, where);
    expect(!part.tintedByColors || (!mesh.colors.empty() && !part.paintedByColors), where,
           "vertex colors that do not paint, where they tint");
    const SurfaceDetail& detail = part.detail;
    if (detail.normalMap) checkTexture(*detail.normalMap, mesh, where);
    if (detail.emissionMap) checkTexture(*detail.emissionMap, mesh, where);
    expect(std::abs(detail.normalScale) <= kLargestNormalScale, where, "a scale of normals of -100 to 100");
    expect(glm::all(glm::greaterThanEqual(detail.emission, vec3(0))) &&
               glm::all(glm::lessThanEqual(detail.emission, vec3(kLargestEmission))),
           where, "an emission of 0 to 1e6");
    expect(!part.paintedByColors || (!mesh.colors.empty() && !part.materialMap), where,
           "vertex colors, and no material map, where colors paint");
}

void checkMaterials(const AssetPart& part, const std::string& where) {
    expect(!part.sets.empty(), where, "at least one set of materials");
    std::vector<std::string_view> names;
    for (const MaterialSet& set : part.sets) {
        expect(!set.materials.empty(), where, "at least one material in a set");
        int layer = 0; // layers belong to one material each, in order
        for (const AssetMaterial& material : set.materials) {
            names.push_back(material.name);
            expectRange(material.layer, layer, layer, where, "a material's layer");
            layer += material.layers();
            expect(std::ranges::none_of(material.name, [](char c) { return uint8_t(c) < 0x20 || c == 0x7f; }),
                   where, "material names without control characters");
            expect(!material.hasBase || part.hasBaseColor(), where, "a base color for a material's base");
        }
        expectRange(set.brdf.layers, layer, layer, where, "layers of view maps");
    }
    std::ranges::sort(names);
    expect(std::ranges::adjacent_find(names) == names.end(), where, "materials of different names");
}

void checkResidual(const ResidualSet& residual, const FactoredBrdf& brdf, const std::string& where) {
    expectCount(residual.layers.size(), size_t(brdf.layers), where, "layers of a residual");
    for (const auto& kernel : residual.layers) {
        expectRange(kernel->frequencies, 0, shared::kMostFrequencies, where, "a kernel's frequencies");
        expectRange(kernel->harmonics, 0, shared::kMostHarmonics, where, "a kernel's harmonics");
        expectCount(kernel->values.size(), kernel->valueCount(), where, "values of a kernel");
        expect(allFinite(kernel->values), where, "finite kernels");
    }
    expectCount(residual.irradianceWeights.size(), size_t(brdf.terms), where, "irradiance weights");
    expect(allFinite(residual.irradianceWeights), where, "finite irradiance weights");
    expect(!residual.hasNonnegativeTerms || isNonnegative(brdf), where, "maps without negative texels");
}

// Checks residuals: sets that share one must have the same factors and frames.
void checkResiduals(const Asset& asset, const std::string& name) {
    std::map<const ResidualSet*, std::pair<const AssetPart*, const FactoredBrdf*>> owners;
    for (const AssetPart& part : asset.parts)
        for (const MaterialSet& set : part.sets) {
            if (!set.residual) continue;
            const std::string where = fmt::format("{}: part \"{}\"", name, part.name);
            const auto [owner, isFirst] = owners.emplace(set.residual.get(), std::pair(&part, &set.brdf));
            if (isFirst) {
                checkResidual(*set.residual, set.brdf, where);
                continue;
            }
            const auto& [first, brdf] = owner->second;
            expect(first->mesh.tangents.empty() == part.mesh.tangents.empty() &&
                       brdf->mapping == set.brdf.mapping && brdf->layers == set.brdf.layers &&
                       brdf->size == set.brdf.size && brdf->lightMaps == set.brdf.lightMaps &&
                       brdf->viewMaps == set.brdf.viewMaps,
                   where, "a residual shared with sets of the same maps and frames alone");
        }
}

std::string partName(const Asset& asset, size_t number, const std::string& name) {
    return fmt::format("{}: part {} (\"{}\")", name, number, asset.parts[number].name);
}

} // namespace

void checkSkeleton(const Asset& asset, const std::string& name) {
    checkSettings(asset, name);
    checkTriangles(asset.occluder, name + ": occluder");
    expect(!asset.parts.empty(), name, "at least one part");
    for (size_t i = 0; i < asset.parts.size(); i++) {
        const AssetPart& part = asset.parts[i];
        const std::string where = partName(asset, i, name);
        checkMesh(part.mesh, where);
        checkPaint(part, where);
        for (const MaterialSet& set : part.sets) {
            checkBrdf(set.brdf, where);
            if (set.directShares.empty()) continue;
            expect(asset.bounces > 0, where, "shares of direct light only where light bounces");
            expectCount(set.directShares.size(), part.mesh.vertexCount() * set.shareWords(), where,
                        "words of shares of direct light");
        }
        checkMaterials(part, where);
    }
    checkResiduals(asset, name);
}

void checkAsset(const Asset& asset, const std::string& name) {
    checkSkeleton(asset, name);
    const auto coefficients = uint32_t(6 * asset.faceSize * asset.faceSize);
    for (size_t i = 0; i < asset.parts.size(); i++) {
        const AssetPart& part = asset.parts[i];
        const std::string where = partName(asset, i, name);
        for (const MaterialSet& set : part.sets) {
            expectCount(verticesOf(set.transport), part.mesh.vertexCount(), where, "vertices with transport");
            expectCount(termsOf(set.transport), size_t(set.brdf.terms), where, "transport terms");
            std::visit(
                [&](const auto& transport) {
                    checkTransport(transport, coefficients, uint64_t(asset.coefficients), where);
                },
                set.transport);
        }
    }
}

} // namespace relume
