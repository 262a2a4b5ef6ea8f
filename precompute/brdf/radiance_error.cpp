#include "engine/base/check.h"
#include "engine/math/cubemap.h"
#include "precompute/brdf/factorization_error.h"
#include "precompute/brdf/random_directions.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

constexpr int kViews = 40; // of each orientation

// The light above one orientation's horizon, texel by texel.
struct LocalLight {
    std::vector<vec3> directions; // in the local frame, unit length
    std::vector<vec3> irradiance; // radiance · cosine · solid angle
};

LocalLight turnLight(const LightCube& light, const mat3& localFromWorld) {
    LocalLight local;
    for (int face = 0, i = 0; face < 6; face++)
        for (int y = 0; y < light.size; y++)
            for (int x = 0; x < light.size; x++, i++) {
                const vec3 direction = localFromWorld * cubeTexelDirection(face, x, y, light.size);
                const vec3 radiance = light.radiance[size_t(i)];
                if (direction.z <= 0 || radiance == vec3(0)) continue;
                local.directions.push_back(direction);
                local.irradiance.push_back(radiance * (direction.z * cubeTexelSolidAngle(x, y, light.size)));
            }
    return local;
}

vec3 exactRadiance(const Brdf& brdf, const LocalLight& light, vec3 view) {
    glm::dvec3 sum(0);
    for (size_t i = 0; i < light.directions.size(); i++)
        sum += glm::dvec3(brdf.evaluate(light.directions[i], view) * light.irradiance[i]);
    return vec3(sum);
}

std::vector<vec3> lightTuple(const FactoredBrdf& factored, const LocalLight& light) {
    std::vector<vec3> tuple(size_t(factored.terms), vec3(0));
    for (size_t i = 0; i < light.directions.size(); i++)
        for (int term = 0; term < factored.terms; term++)
            tuple[size_t(term)] += light.irradiance[i] * lookupMap(factored.lightMap(term), factored.size,
                                                                   factored.mapping, light.directions[i]);
    return tuple;
}

// Squared errors of one orientation, after each term; added to `sums`.
void addErrors(const LayerOf& approximation, const LocalLight& light, const std::vector<vec3>& views,
               const std::vector<vec3>& exact, std::vector<double>& sums) {
    const FactoredBrdf& factored = *approximation.factored;
    const std::vector<vec3> tuple = lightTuple(factored, light);
    for (size_t v = 0; v < views.size(); v++) {
        vec3 sum(0);
        for (int term = 0; term < factored.terms; term++) {
            sum += tuple[size_t(term)] * lookupMap(factored.viewMap(approximation.layer, term), factored.size,
                                                   factored.mapping, views[v]);
            const vec3 error = glm::max(sum, vec3(0)) - exact[v];
            sums[size_t(term)] += double(glm::dot(error, error));
        }
    }
}

} // namespace

std::vector<std::vector<float>> radianceErrors(const Brdf& brdf, std::span<const LayerOf> factored,
                                               const LightCube& light, const RadianceErrorOptions& options) {
    RELUME_CHECK_LE(1, options.orientations);
    struct Orientation {
        mat3 localFromWorld;
        std::vector<vec3> views;
        double total = 0;
        std::vector<std::vector<double>> sums; // per factored BRDF and term
    };
    RandomDirections random(6040);
    std::vector<Orientation> orientations(size_t(options.orientations));
    for (Orientation& orientation : orientations) {
        orientation.localFromWorld = random.rotation();
        for (int v = 0; v < kViews; v++)
            orientation.views.push_back(options.uniform ? random.uniformHemisphere()
                                                        : random.cosineHemisphere());
    }
    tbb::parallel_for(size_t(0), orientations.size(), [&](size_t o) {
        Orientation& orientation = orientations[o];
        const LocalLight local = turnLight(light, orientation.localFromWorld);
        std::vector<vec3> exact;
        for (const vec3& view : orientation.views) {
            exact.push_back(exactRadiance(brdf, local, view));
            orientation.total += double(glm::dot(exact.back(), exact.back()));
        }
        for (const LayerOf& approximation : factored)
            addErrors(approximation, local, orientation.views, exact,
                      orientation.sums.emplace_back(size_t(approximation.factored->terms), 0.0));
    });
    std::vector<std::vector<float>> errors;
    for (size_t a = 0; a < factored.size(); a++) {
        std::vector<float>& curve = errors.emplace_back();
        for (size_t k = 0; k < size_t(factored[a].factored->terms); k++) {
            double sum = 0, total = 0;
            for (const Orientation& orientation : orientations) {
                sum += orientation.sums[a][k];
                total += orientation.total;
            }
            curve.push_back(total > 0 ? float(std::sqrt(sum / total)) : 0);
        }
    }
    return errors;
}

} // namespace relume
