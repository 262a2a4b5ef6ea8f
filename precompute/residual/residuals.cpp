#include "precompute/residual/residuals.h"

#include "engine/base/error.h"
#include "engine/base/log.h"
#include "precompute/brdf/material_brdfs.h"
#include "precompute/residual/sphere_kernel.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <fmt/core.h>

namespace relume {

namespace {

constexpr double kExactTerms = 1e-5; // squared error, relative to f², below which terms count as exact

// A layer of a set's view maps: its exact BRDF.
struct Layer {
    Reflectance exact;
    bool isIsotropic;
};

// Returns the layers of a set. A material has f as its layer, or f without the part that a base color texture
// multiplies, and then that part.
std::vector<Layer> layersOf(const MaterialSet& set, MaterialBrdfs& brdfs) {
    std::vector<Layer> layers(static_cast<size_t>(set.brdf.layers));
    for (const AssetMaterial& material : set.materials) {
        const std::shared_ptr<const Brdf> brdf = brdfs.of(material);
        Layer* const layer = &layers[size_t(material.layer)];
        for (int i = 0; i < material.layers(); i++) layer[i].isIsotropic = brdf->isIsotropic();
        if (!material.hasBase) {
            layer->exact = [brdf](vec3 incoming, vec3 outgoing) {
                return brdf->evaluate(incoming, outgoing);
            };
            continue;
        }
        layer[0].exact = [brdf](vec3 incoming, vec3 outgoing) {
            return glm::max(brdf->evaluate(incoming, outgoing) - brdf->evaluateBase(incoming, outgoing),
                            vec3(0));
        };
        layer[1].exact = [brdf](vec3 incoming, vec3 outgoing) {
            return brdf->evaluateBase(incoming, outgoing);
        };
    }
    return layers;
}

// Returns whether the terms of a layer equal its BRDF, tested at a few hundred pairs of directions.
bool isExact(const Reflectance& exact, const FactoredBrdf& factors, int layer) {
    constexpr int kDirections = 24;
    const auto direction = [](int i, float turn) {
        const float squared = (float(i) + 0.5f) / kDirections;
        const float azimuth = (turn + float(i) * 0.618034f) * 2 * kPi;
        return vec3(std::sqrt(squared) * std::cos(azimuth), std::sqrt(squared) * std::sin(azimuth),
                    std::sqrt(1 - squared));
    };
    double difference = 0, all = 0;
    for (int i = 0; i < kDirections; i++)
        for (int o = 0; o < kDirections; o++) {
            const vec3 incoming = direction(i, 0), outgoing = direction(o, 0.37f);
            const vec3 f = exact(incoming, outgoing),
                       missed = evaluate(factors, incoming, outgoing, layer) - f;
            difference += double(glm::dot(missed, missed));
            all += double(glm::dot(f, f));
        }
    return difference <= kExactTerms * all;
}

std::shared_ptr<const ResidualSet> makeSet(const MaterialSet& set, bool includesExact, MaterialBrdfs& brdfs) {
    const std::vector<Layer> layers = layersOf(set, brdfs);
    bool allExact = !includesExact;
    for (size_t layer = 0; layer < layers.size(); layer++)
        allExact &= isExact(layers[layer].exact, set.brdf, int(layer));
    if (allExact) return nullptr;
    auto residual = std::make_shared<ResidualSet>();
    for (const Layer& layer : layers)
        residual->layers.push_back(makeSphereKernel(layer.exact, layer.isIsotropic));
    residual->hasNonnegativeTerms = isNonnegative(set.brdf);
    residual->irradianceWeights = irradianceWeights(set.brdf);
    return residual;
}

// Returns whether two sets have the same materials and factors.
bool isSame(const MaterialSet& a, const MaterialSet& b) {
    return std::ranges::equal(a.materials, b.materials, {}, &AssetMaterial::description,
                              &AssetMaterial::description) &&
           std::ranges::equal(a.materials, b.materials, {}, &AssetMaterial::hasBase,
                              &AssetMaterial::hasBase) &&
           a.brdf.mapping == b.brdf.mapping && a.brdf.lightMaps == b.brdf.lightMaps &&
           a.brdf.viewMaps == b.brdf.viewMaps;
}

} // namespace

void makeResiduals(Asset& asset, bool includesExact) {
    MaterialBrdfs brdfs;
    // Sets that have a residual, of parts whose frames follow tangents or normals.
    std::vector<const MaterialSet*> ofTangents, ofNormals;
    const auto knownOf = [&](const AssetPart& part) -> auto& {
        return part.mesh.tangents.empty() ? ofNormals : ofTangents;
    };
    for (const AssetPart& part : asset.parts)
        for (const MaterialSet& set : part.sets)
            if (set.residual) knownOf(part).push_back(&set);
    for (AssetPart& part : asset.parts)
        for (MaterialSet& set : part.sets) {
            if (set.residual) continue;
            auto& known = knownOf(part);
            const auto same =
                std::ranges::find_if(known, [&](const MaterialSet* other) { return isSame(*other, set); });
            if (same != known.end()) {
                set.residual = (*same)->residual;
                continue;
            }
            known.push_back(&set);
            try {
                set.residual = makeSet(set, includesExact, brdfs);
            } catch (const Error& error) {
                log(LogLevel::Warning, fmt::format("{}: drawn without the residual, by its K terms alone: {}",
                                                   part.name, error.what()));
            }
        }
}

std::vector<vec3> irradianceWeights(const FactoredBrdf& factors) {
    // Equal steps of the squared sine sample directions in proportion to the cosine.
    constexpr int kAngles = 48, kAzimuths = 96;
    const int terms = factors.terms;
    std::vector<vec3> directions;
    for (int j = 0; j < kAngles; j++)
        for (int i = 0; i < kAzimuths; i++) {
            const float squared = (float(j) + 0.5f) / kAngles, sine = std::sqrt(squared);
            const float azimuth = 2 * kPi * (float(i) + 0.5f) / kAzimuths;
            directions.emplace_back(sine * std::cos(azimuth), sine * std::sin(azimuth),
                                    std::sqrt(1 - squared));
        }
    const auto count = Eigen::Index(directions.size());
    std::vector<vec3> result(size_t(terms), vec3(0));
    for (int channel = 0; channel < 3; channel++) {
        Eigen::MatrixXd maps(count, terms);
        for (Eigen::Index i = 0; i < count; i++) {
            const MapPlace place = placeInMap(factors.size, factors.mapping, directions[size_t(i)]);
            for (int term = 0; term < terms; term++)
                maps(i, term) = double(lookupMap(factors.lightMap(term), place)[channel]);
        }
        // Regularize, since terms may be linearly dependent and a channel may be black.
        Eigen::MatrixXd normal = maps.transpose() * maps;
        normal.diagonal().array() += 1e-9 * std::max(normal.trace(), 1e-30);
        const Eigen::VectorXd weights = normal.ldlt().solve(maps.transpose() * Eigen::VectorXd::Ones(count));
        for (int term = 0; term < terms; term++) result[size_t(term)][channel] = float(weights[term]);
    }
    return result;
}

} // namespace relume
