#include "precompute/error/error_grid.h"

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "precompute/error/shared_progress.h"
#include "precompute/error/unshadowed_light.h"
#include "precompute/reference/reference_image.h"
#include "precompute/reference/vertex_views.h"
#include "precompute/residual/residuals.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

constexpr size_t kRungs = kTriedCoefficients.size();

struct SeenPoint {
    vec3 eye;
    const RayHit* hit;
};

std::vector<SeenPoint> listPoints(std::span<const SeenPoints> points) {
    std::vector<SeenPoint> list;
    for (const SeenPoints& seen : points)
        for (const RayHit& hit : seen.hits) list.push_back({seen.eye, &hit});
    return list;
}

// One row at every tried N: its tuples under the lights, and the entries left after quantization.
struct Ladder {
    std::array<std::array<vec3, kRungs>, kLightParts> tuples{}; // by LightPart
    std::array<float, kRungs> entries{};
};

using LightCoefficients = std::array<std::vector<vec3>, kLightParts>; // Haar, by LightPart

Ladder climb(const std::vector<vec3>& coefficients, const LightCoefficients& lights) {
    std::vector<uint32_t> order;
    float scale = 0;
    for (uint32_t i = 0; i < coefficients.size(); i++) {
        if (coefficients[i] == vec3(0)) continue;
        order.push_back(i);
        const vec3 magnitude = glm::abs(coefficients[i]);
        scale = std::max({scale, magnitude.x, magnitude.y, magnitude.z});
    }
    const auto key = [&](uint32_t i) { return glm::dot(coefficients[i], coefficients[i]); };
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        const float keyA = key(a), keyB = key(b);
        return keyA > keyB || (keyA == keyB && a < b);
    });
    Ladder ladder;
    std::array<glm::dvec3, kLightParts> sums{};
    float entries = 0;
    size_t next = 0;
    for (size_t rung = 0; rung < kRungs; rung++) {
        for (; next < order.size() && next < size_t(kTriedCoefficients[rung]); next++) {
            const vec3 coefficient = coefficients[order[next]];
            for (size_t light = 0; light < kLightParts; light++)
                sums[light] += glm::dvec3(coefficient * lights[light][order[next]]);
            entries += quantizeCoefficient(coefficient, scale) != ivec3(0);
        }
        for (size_t light = 0; light < kLightParts; light++) ladder.tuples[light][rung] = vec3(sums[light]);
        ladder.entries[rung] = entries;
    }
    return ladder;
}

// The ladders of sampled vertices.
class VertexLadders {
  public:
    VertexLadders(const Asset& asset, const Appearance& appearance, const DrawnLight& light)
        : mAsset(asset), mAppearance(appearance),
          mTransport(asset), mLights{dequantizedLight(light[0].entries), dequantizedLight(light[1].entries)} {
    }

    void add(uint32_t part, uint32_t vertex) { mLadders[{part, vertex}]; }

    void fill(const std::function<void(double)>& progress) {
        std::vector<std::pair<const Key, std::vector<Ladder>>*> entries;
        for (auto& entry : mLadders) entries.push_back(&entry);
        SharedProgress shared(progress, 0, 1, entries.size());
        tbb::parallel_for(size_t(0), entries.size(), [&](size_t i) {
            entries[i]->second = laddersOf(entries[i]->first.first, entries[i]->first.second);
            shared.add();
        });
    }

    // Returns a ladder per term.
    const std::vector<Ladder>& at(uint32_t part, uint32_t vertex) const {
        return mLadders.at({part, vertex});
    }

    void addEntries(ErrorGrid& grid) const {
        std::vector<double> counts(mAsset.parts.size(), 0);
        for (const auto& [key, ladders] : mLadders) {
            counts[key.first]++;
            for (size_t term = 0; term < ladders.size(); term++)
                for (size_t rung = 0; rung < kRungs; rung++)
                    grid.entries[key.first][term][rung] += double(ladders[term].entries[rung]);
        }
        for (size_t part = 0; part < counts.size(); part++)
            for (auto& term : grid.entries[part])
                for (double& entries : term) entries /= std::max(counts[part], 1.0);
    }

  private:
    using Key = std::pair<uint32_t, uint32_t>; // part, vertex

    std::vector<Ladder> laddersOf(uint32_t part, uint32_t vertex) const {
        const FactoredBrdf& brdf = mAsset.parts[part].sets[mAppearance[part].set].brdf;
        std::vector<Ladder> ladders;
        mTransport.forEachTerm(part, vertex, brdf, [&](size_t, const std::vector<vec3>& coefficients) {
            ladders.push_back(climb(coefficients, mLights));
        });
        return ladders;
    }

    const Asset& mAsset;
    const Appearance& mAppearance;
    BakedTransport mTransport;
    LightCoefficients mLights;
    std::map<Key, std::vector<Ladder>> mLadders;
};

const FactoredBrdf& boundFactors(const Asset& asset, const Appearance& appearance, size_t part) {
    return asset.parts[part].sets[appearance[part].set].brdf;
}

// Returns the bound view maps' values at a point, per term.
std::vector<vec3> viewsAt(const Asset& asset, const Appearance& appearance, size_t part,
                          const SurfacePoint& point) {
    return pointViews(boundFactors(asset, appearance, part), boundLayers(asset.parts[part], appearance[part]),
                      point.layerWeights(), point.outgoing);
}

// Returns the interpolated tuple.
std::vector<vec3> tupleAt(const VertexLadders& vertices, const Asset& asset, const RayHit& hit, LightPart lit,
                          size_t rung, size_t terms) {
    const uvec3 corners = asset.parts[hit.mesh].mesh.triangles[hit.triangle];
    std::vector<vec3> tuple(terms, vec3(0));
    for (int corner = 0; corner < 3; corner++) {
        const std::vector<Ladder>& ladders = vertices.at(hit.mesh, corners[corner]);
        for (size_t term = 0; term < terms; term++)
            tuple[term] += hit.weights[corner] * ladders[term].tuples[size_t(lit)][rung];
    }
    return tuple;
}

// Returns the residuals of the part's bound set cut to its first 1, 2, … K terms; empty if terms are drawn
// alone.
std::vector<ResidualSet> residualsOfPrefixes(const Asset& asset, const Appearance& appearance, size_t part) {
    if (!asset.parts[part].sets[appearance[part].set].residual) return {};
    FactoredBrdf factors = boundFactors(asset, appearance, part);
    std::vector<ResidualSet> prefixes;
    for (; factors.terms > 0; factors.terms--) {
        factors.lightMaps.resize(size_t(factors.terms) * factors.mapTexels());
        prefixes.push_back({.irradianceWeights = irradianceWeights(factors)});
    }
    return {prefixes.rbegin(), prefixes.rend()};
}

} // namespace

std::vector<vec3> exactRadiance(const Asset& asset, const Appearance& appearance,
                                std::span<const SeenPoints> points, const LightCube& fine,
                                const std::function<void(double)>& progress) {
    RELUME_CHECK_EQ(fine.size, kTruthFaceSize);
    const CubeCells cells(kTruthFaceSize);
    const std::vector<vec3> light = cells.ordered(fine);
    const CpuVisibility visibility(mergedMesh(asset), kTruthFaceSize);
    const float offset = kFullMeshShadowOffset * boundsOf(asset).radius();
    MaterialBrdfs brdfs;
    const BoundAsset bound(asset, appearance, ReferenceBrdf::Exact, brdfs);
    const std::vector<SeenPoint> list = listPoints(points);
    std::vector<vec3> radiance(list.size());
    SharedProgress shared(progress, 0, 1, list.size());
    tbb::parallel_for(size_t(0), list.size(), [&](size_t i) {
        const SurfacePoint point = bound.pointAt(*list[i].hit, list[i].eye);
        std::vector<uint64_t> bits(visibility.texels() / 64);
        visibility.trace(point.position + offset * point.normal, point.normal, bits);
        glm::dvec3 sum(0);
        for (size_t cell = 0; cell < cells.count(); cell++) {
            if (!(bits[cell / 64] >> (cell % 64) & 1)) continue;
            const vec3 local = point.frame.toLocal(cells.directions[cell]);
            if (!(local.z > 0)) continue;
            sum += glm::dvec3(local.z * cells.solidAngles[cell] * light[cell] * point.reflected(local));
        }
        radiance[i] = vec3(sum);
        shared.add();
    });
    return radiance;
}

ErrorGrid errorGrid(const Asset& asset, const Appearance& appearance, std::span<const SeenPoints> points,
                    std::span<const vec3> exact, const DrawnLight& light,
                    const std::function<void(double)>& progress) {
    const std::vector<SeenPoint> list = listPoints(points);
    RELUME_CHECK_EQ(list.size(), exact.size());
    RELUME_CHECK(!list.empty());
    RELUME_CHECK_EQ(light[0].cube.size, asset.faceSize);

    ErrorGrid grid;
    grid.shares.assign(asset.parts.size(), 0);
    for (size_t part = 0; part < asset.parts.size(); part++) {
        const int terms = asset.parts[part].sets[appearance[part].set].brdf.terms;
        grid.terms = std::max(grid.terms, terms);
        grid.entries.emplace_back(size_t(terms));
    }
    VertexLadders vertices(asset, appearance, light);
    for (const SeenPoint& seen : list) {
        const uvec3 corners = asset.parts[seen.hit->mesh].mesh.triangles[seen.hit->triangle];
        for (int corner = 0; corner < 3; corner++) vertices.add(seen.hit->mesh, corners[corner]);
    }
    // Parts that are hardly visible take bytes, too.
    constexpr uint32_t kLeastOfPart = 16;
    for (uint32_t part = 0; part < asset.parts.size(); part++) {
        const auto all = uint32_t(asset.parts[part].mesh.vertexCount());
        const uint32_t count = std::min(all, kLeastOfPart);
        for (uint32_t i = 0; i < count; i++) vertices.add(part, uint32_t(uint64_t(all) * i / count));
    }
    vertices.fill(progress);
    vertices.addEntries(grid);

    MaterialBrdfs brdfs;
    const BoundAsset bound(asset, appearance, ReferenceBrdf::Exact, brdfs);
    const BakedTransport transport(asset);
    const std::array<std::span<const vec3>, kLightParts> cubes = {light[0].cube.radiance,
                                                                  light[1].cube.radiance};
    std::vector<std::vector<ResidualSet>> prefixes;
    for (size_t part = 0; part < asset.parts.size(); part++)
        prefixes.push_back(residualsOfPrefixes(asset, appearance, part));
    double level = 0;
    grid.errors.resize(size_t(grid.terms));
    for (size_t i = 0; i < list.size(); i++) {
        const RayHit& hit = *list[i].hit;
        const SurfacePoint point = bound.pointAt(hit, list[i].eye);
        const SurfacePoint baked = bound.bakedPointAt(hit, list[i].eye);
        const std::vector<vec3> views = viewsAt(asset, appearance, hit.mesh, baked);
        const std::vector<ResidualSet>& ofPrefixes = prefixes[hit.mesh];
        std::vector<UnshadowedLight> unshadowed(kLightParts);
        if (!ofPrefixes.empty())
            unshadowed =
                sumUnshadowed(transport, point, baked,
                              point.frame.n == baked.frame.n ? baked : bound.limitPointAt(hit, list[i].eye),
                              boundFactors(asset, appearance, hit.mesh), cubes);
        std::array<std::vector<vec3>, kRungs> whole, fill;
        for (size_t rung = 0; rung < kRungs; rung++) {
            whole[rung] = tupleAt(vertices, asset, hit, LightPart::Whole, rung, views.size());
            fill[rung] = tupleAt(vertices, asset, hit, LightPart::Fill, rung, views.size());
        }
        for (size_t terms = 1; terms <= size_t(grid.terms); terms++) {
            const size_t own = std::min(terms, views.size());
            const ResidualSet* residual = ofPrefixes.empty() ? nullptr : &ofPrefixes[own - 1];
            for (size_t rung = 0; rung < kRungs; rung++) {
                const auto of = [own](const std::vector<vec3>& tuple) { return std::span(tuple).first(own); };
                const vec3 radiance = estimateRadiance(
                    residual, std::span(views).first(own), {of(whole[rung]), of(whole[rung]), unshadowed[0]},
                    {of(fill[rung]), of(fill[rung]), unshadowed[1]}); // all light is direct
                const glm::dvec3 error = glm::dvec3(radiance) - glm::dvec3(exact[i]);
                grid.errors[terms - 1][rung] += glm::dot(error, error);
            }
        }
        level += glm::dot(glm::dvec3(exact[i]), glm::dvec3(exact[i]));
        grid.shares[hit.mesh] += 1 / double(list.size());
    }
    if (level == 0) throw Error("what is seen is black: under no light no error can be told");
    grid.level = std::sqrt(level / (3 * double(list.size())));
    for (auto& errors : grid.errors)
        for (double& error : errors) error = std::sqrt(error / level);
    return grid;
}

} // namespace relume
