#include "precompute/error/unshadowed_light.h"

#include "precompute/residual/residual_estimate.h"
#include "shaders/shared/render.h"

namespace relume {

namespace {

EstimateSums sumTerms(const ResidualSet& residual, std::span<const vec3> views, const PointLight& light) {
    EstimateSums sums;
    sums.exact = glm::min(light.unshadowed.exact, light.unshadowed.most);
    for (size_t term = 0; term < views.size(); term++) {
        const vec3 weight = residual.hasNonnegativeTerms ? vec3(1) : residual.irradianceWeights[term];
        const vec3 free = light.unshadowed.tuple[term];
        sums.shadowed += views[term] * light.tuple[term];
        sums.terms += views[term] * free;
        sums.lit += weight * light.tuple[term];
        sums.direct += views[term] * light.direct[term];
        sums.directLit += weight * light.direct[term];
        sums.unlit += weight * free;
    }
    return sums;
}

vec3 estimate(const EstimateSums& sums, const ResidualSet& residual, vec3 leastView) {
    return residual.hasNonnegativeTerms ? ratioEstimate(sums, leastView, residual.isBounced)
                                        : differenceEstimate(sums, residual.isBounced);
}

// Returns the unshadowed radiance of a point, per light.
std::vector<glm::dvec3> sumExact(std::span<const LitCell> lit, const SurfacePoint& point,
                                 std::span<const std::span<const vec3>> lights) {
    std::vector<glm::dvec3> exact(lights.size(), glm::dvec3(0));
    for (const LitCell& cell : lit) {
        const vec3 reflected = cell.weight * point.reflected(cell.local);
        for (size_t light = 0; light < lights.size(); light++)
            exact[light] += glm::dvec3(reflected * lights[light][cell.texel]);
    }
    return exact;
}

} // namespace

std::vector<UnshadowedLight> sumUnshadowed(const BakedTransport& transport, const SurfacePoint& point,
                                           const SurfacePoint& baked, const SurfacePoint& limit,
                                           const FactoredBrdf& factors,
                                           std::span<const std::span<const vec3>> lights) {
    const std::vector<uint64_t> free(transport.visibilityWords(), ~uint64_t(0));
    const std::vector<LitCell> lit = transport.lit(free, baked.frame);
    const std::vector<MapPlace> places = placesOf(lit, factors.size, factors.mapping);
    const auto terms = size_t(factors.terms);
    std::vector<glm::dvec3> tuples(lights.size() * terms);
    const bool isMapped = point.frame.n != baked.frame.n;
    const std::vector<glm::dvec3> exact =
        sumExact(isMapped ? transport.lit(free, point.frame) : lit, point, lights);
    const std::vector<glm::dvec3> most = isMapped ? sumExact(lit, limit, lights) : exact;
    for (size_t i = 0; i < lit.size(); i++) {
        for (size_t term = 0; term < terms; term++) {
            const vec3 map = lit[i].weight * lookupMap(factors.lightMap(int(term)), places[i]);
            for (size_t light = 0; light < lights.size(); light++)
                tuples[light * terms + term] += glm::dvec3(map * lights[light][lit[i].texel]);
        }
    }
    std::vector<UnshadowedLight> unshadowed;
    for (size_t light = 0; light < lights.size(); light++) {
        const auto first = tuples.begin() + std::ptrdiff_t(light * terms);
        unshadowed.push_back({glm::max(vec3(exact[light]), vec3(0)),
                              glm::max(vec3(most[light]), vec3(0)),
                              {first, first + std::ptrdiff_t(terms)}});
    }
    return unshadowed;
}

vec3 estimateRadiance(const ResidualSet* residual, std::span<const vec3> views, const PointLight& whole,
                      const PointLight& fill) {
    vec3 shadowed(0);
    for (size_t term = 0; term < views.size(); term++) shadowed += views[term] * whole.tuple[term];
    if (!residual) return glm::max(shadowed, vec3(0));
    const EstimateSums all = sumTerms(*residual, views, whole), own = sumTerms(*residual, views, fill);
    const auto beyond = [](vec3 a, vec3 b) { return glm::max(a - b, vec3(0)); };
    const EstimateSums key = keyOf(all, own,
                                   glm::min(beyond(whole.unshadowed.exact, fill.unshadowed.exact),
                                            beyond(whole.unshadowed.most, fill.unshadowed.most)));
    return estimate(own, *residual, vec3(shared::kLeastView)) + estimate(key, *residual, keyLeastView(views));
}

} // namespace relume
