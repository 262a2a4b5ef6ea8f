#include "engine/base/check.h"
#include "engine/math/cubemap.h"
#include "precompute/brdf/brdf.h"
#include "precompute/brdf/factorization_error.h"
#include "precompute/brdf/random_directions.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

constexpr int kViewDirections = 40; // per orientation

// The lights above an orientation's horizon, texel by texel.
struct LocalLights {
    std::vector<vec3> directions;              // unit vectors in the local frame
    std::vector<std::vector<vec3>> irradiance; // per light: radiance · cosine · solid angle
};

LocalLights turnLights(std::span<const LightCube> lights, const mat3& localFromWorld) {
    LocalLights local;
    local.irradiance.resize(lights.size());
    const int size = lights[0].size;
    for (int face = 0, i = 0; face < 6; face++)
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++, i++) {
                const vec3 direction = localFromWorld * cubeTexelDirection(face, x, y, size);
                const bool isDark = std::all_of(lights.begin(), lights.end(), [&](const LightCube& light) {
                    return light.radiance[size_t(i)] == vec3(0);
                });
                if (direction.z <= 0 || isDark) continue;
                local.directions.push_back(direction);
                for (size_t l = 0; l < lights.size(); l++)
                    local.irradiance[l].push_back(lights[l].radiance[size_t(i)] *
                                                  (direction.z * cubeTexelSolidAngle(x, y, size)));
            }
    return local;
}

// Returns the radiance of the exact BRDF, per light.
std::vector<vec3> exactRadiance(const Brdf& brdf, const LocalLights& lights, vec3 view) {
    std::vector<glm::dvec3> sums(lights.irradiance.size(), glm::dvec3(0));
    for (size_t i = 0; i < lights.directions.size(); i++) {
        const vec3 value = brdf.evaluate(lights.directions[i], view);
        for (size_t l = 0; l < sums.size(); l++) sums[l] += glm::dvec3(value * lights.irradiance[l][i]);
    }
    return {sums.begin(), sums.end()};
}

// Distributes every light over a map's texels with the weights of bilinear lookups: for any map, Σ texel ·
// weight is the sum over the light of irradiance times lookup.
std::vector<std::vector<vec3>> spreadOverMap(const LocalLights& lights, int size, DiskMapping mapping) {
    std::vector<std::vector<vec3>> spread(lights.irradiance.size(),
                                          std::vector<vec3>(size_t(size) * size_t(size), vec3(0)));
    for (size_t i = 0; i < lights.directions.size(); i++) {
        const MapPlace place = placeInMap(size, mapping, lights.directions[i]);
        const vec2 far = place.weight, near = 1.0f - far;
        const float weights[] = {near.x * near.y, far.x * near.y, near.x * far.y, far.x * far.y};
        for (size_t l = 0; l < spread.size(); l++)
            for (size_t t = 0; t < 4; t++)
                spread[l][size_t(place.texels[t])] += weights[t] * lights.irradiance[l][i];
    }
    return spread;
}

// Returns the squared errors of one orientation under one light after each term. `exact` is the radiance per
// view.
std::vector<double> squaredErrors(const LayerOf& approximation, const std::vector<vec3>& spread,
                                  const std::vector<MapPlace>& views, const std::vector<vec3>& exact) {
    const FactoredBrdf& factored = *approximation.factored;
    std::vector<vec3> radiance(views.size(), vec3(0));
    std::vector<double> errors(size_t(factored.terms), 0.0);
    for (int term = 0; term < factored.terms; term++) {
        const vec3* map = factored.lightMap(term);
        vec3 lit(0);
        for (size_t texel = 0; texel < spread.size(); texel++) lit += map[texel] * spread[texel];
        for (size_t v = 0; v < views.size(); v++) {
            radiance[v] += lit * lookupMap(factored.viewMap(approximation.layer, term), views[v]);
            const vec3 error = glm::max(radiance[v], vec3(0)) - exact[v];
            errors[size_t(term)] += double(glm::dot(error, error));
        }
    }
    return errors;
}

struct Orientation {
    mat3 localFromWorld;
    std::vector<vec3> views;
    std::vector<double> totals;                         // per light
    std::vector<std::vector<std::vector<double>>> sums; // per light, factored BRDF and term
};

void measure(const Brdf& brdf, std::span<const LayerOf> factored, std::span<const LightCube> lights,
             Orientation& orientation) {
    const LocalLights local = turnLights(lights, orientation.localFromWorld);
    std::vector<std::vector<vec3>> exact(lights.size()); // per light and view
    orientation.totals.assign(lights.size(), 0);
    orientation.sums.resize(lights.size());
    for (const vec3& view : orientation.views) {
        const std::vector<vec3> radiance = exactRadiance(brdf, local, view);
        for (size_t l = 0; l < lights.size(); l++) {
            exact[l].push_back(radiance[l]);
            orientation.totals[l] += double(glm::dot(radiance[l], radiance[l]));
        }
    }
    std::vector<std::vector<vec3>> spread;
    for (size_t a = 0; a < factored.size(); a++) {
        const FactoredBrdf& maps = *factored[a].factored;
        const FactoredBrdf* last = a > 0 ? factored[a - 1].factored : nullptr;
        if (!last || last->size != maps.size || last->mapping != maps.mapping)
            spread = spreadOverMap(local, maps.size, maps.mapping);
        std::vector<MapPlace> views;
        for (const vec3& view : orientation.views) views.push_back(placeInMap(maps.size, maps.mapping, view));
        for (size_t l = 0; l < lights.size(); l++)
            orientation.sums[l].push_back(squaredErrors(factored[a], spread[l], views, exact[l]));
    }
}

} // namespace

std::vector<std::vector<std::vector<float>>> radianceErrors(const Brdf& brdf,
                                                            std::span<const LayerOf> factored,
                                                            std::span<const LightCube> lights,
                                                            const RadianceErrorOptions& options) {
    RELUME_CHECK_LE(1, options.orientations);
    for (const LightCube& light : lights) RELUME_CHECK_EQ(light.size, lights[0].size);
    if (lights.empty()) return {};
    RandomDirections random(6040);
    std::vector<Orientation> orientations(size_t(options.orientations));
    for (Orientation& orientation : orientations) {
        orientation.localFromWorld = random.rotation();
        for (int v = 0; v < kViewDirections; v++)
            orientation.views.push_back(options.uniform ? random.uniformHemisphere()
                                                        : random.cosineHemisphere());
    }
    tbb::parallel_for(size_t(0), orientations.size(),
                      [&](size_t o) { measure(brdf, factored, lights, orientations[o]); });
    std::vector<std::vector<std::vector<float>>> errors(lights.size());
    for (size_t l = 0; l < lights.size(); l++)
        for (size_t a = 0; a < factored.size(); a++) {
            std::vector<float>& curve = errors[l].emplace_back();
            for (size_t k = 0; k < size_t(factored[a].factored->terms); k++) {
                double sum = 0, total = 0;
                for (const Orientation& orientation : orientations) {
                    sum += orientation.sums[l][a][k];
                    total += orientation.totals[l];
                }
                curve.push_back(total > 0 ? float(std::sqrt(sum / total)) : 0);
            }
        }
    return errors;
}

std::vector<std::vector<float>> radianceErrors(const Brdf& brdf, std::span<const LayerOf> factored,
                                               const LightCube& light, const RadianceErrorOptions& options) {
    return radianceErrors(brdf, factored, std::span(&light, 1), options)[0];
}

} // namespace relume
