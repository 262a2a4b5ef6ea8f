#include "precompute/reference/reference_image.h"

#include "engine/base/error.h"
#include "engine/light/fill_light.h"
#include "engine/math/cubemap.h"
#include "engine/transport/asset_check.h"
#include "precompute/reference/bound_asset.h"
#include "precompute/reference/path_sampling.h"
#include "precompute/reference/pixel_hits.h"
#include "precompute/reference/vertex_views.h"
#include "precompute/residual/residual_estimate.h"
#include "shaders/shared/light.h"
#include "shaders/shared/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/core.h>
#include <mutex>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

// A direction of incident light, with radiance · solid angle: of the whole light, and of its fill.
struct LightSample {
    vec3 direction;
    vec3 energy, fill;
};

// Side, in texels, of the light cube that paths sample if the light is an environment.
constexpr int kPathFaceSize = 128;

int bouncesOf(const ReferenceOptions& options, const Asset& asset) {
    return options.bounces.value_or(options.brdf == ReferenceBrdf::Exact ? asset.bounces : 0);
}

// Data shared by all pixels.
struct Renderer {
    const Camera& camera;
    const ReferenceOptions& options;
    std::vector<LightSample> lights;
    BoundAsset asset;
    std::optional<BoundAsset> terms; // for ReferenceBrdf::Residual: the asset with its K terms as BRDFs
    // For ReferenceBrdf::Residual, per part, of its bound set: factors; layers; the sum of the light maps,
    // empty unless terms are nonnegative.
    std::vector<const FactoredBrdf*> boundFactors;
    std::vector<std::vector<BoundLayer>> boundLayersOf;
    std::vector<std::vector<vec3>> lightMapSums;
    RayTracer surfaces;                       // one mesh per part
    std::unique_ptr<RayTracer> withoutGround; // the same, if the ground is hidden from the eye; else null
    RayTracer occluder;
    float shadowOffset;
    int bounces;
    std::optional<LightDistribution> bounced; // light that paths sample, if it bounces
    std::vector<const Mesh*> meshes;

    vec4 pixelAt(int x, int y) const;
    vec3 radianceAt(const RayHit& hit) const;
    // Returns the reflected radiance that a surface would have if nothing cast shadows.
    vec3 unshadowedRadiance(const RayHit& hit) const;
    // Returns bounced radiance by path tracing; the pixel seeds the random numbers.
    vec3 bouncedRadiance(const RayHit& hit, uint32_t pixel) const;
    // Returns the coverage of a surface: less than 1 where the ground fades.
    float coverageAt(const RayHit& hit) const;
    vec3 reflectedRadiance(const SurfacePoint& point) const;
    vec3 estimateRadiance(const RayHit& hit) const;
};

vec3 Renderer::radianceAt(const RayHit& hit) const {
    return terms ? estimateRadiance(hit) : reflectedRadiance(asset.pointAt(hit, camera.eye));
}

vec3 Renderer::unshadowedRadiance(const RayHit& hit) const {
    const SurfacePoint point = asset.pointAt(hit, camera.eye);
    glm::dvec3 sum(0);
    for (const LightSample& light : lights) {
        const vec3 incoming = point.frame.toLocal(light.direction);
        if (incoming.z > 0) sum += light.energy * point.reflected(incoming) * incoming.z;
    }
    return vec3(sum);
}

vec3 Renderer::bouncedRadiance(const RayHit& hit, uint32_t pixel) const {
    const SurfacePoint point = asset.pointAt(hit, camera.eye);
    const PathScene scene{asset, surfaces, occluder, meshes, *bounced, shadowOffset};
    glm::dvec3 sum(0);
    for (int path = 0; path < options.paths; path++) {
        HashedNumbers random(pixel, uint32_t(path));
        std::array<vec3, kMostBounces> byBounces{};
        sampleBounces(scene, point, std::span(byBounces).first(size_t(bounces)), random);
        for (const vec3 radiance : byBounces) sum += radiance;
    }
    return vec3(sum / double(options.paths));
}

float Renderer::coverageAt(const RayHit& hit) const {
    if (!options.groundFade || options.groundFade->part != hit.mesh) return 1;
    return groundCoverage(*options.groundFade, asset.pointAt(hit, camera.eye).position);
}

vec4 Renderer::pixelAt(int x, int y) const {
    std::array<std::optional<RayHit>, kMostSamples> samples;
    const std::span hits(samples.data(), size_t(options.samples));
    findPixelHits(withoutGround ? *withoutGround : surfaces, camera, {x, y}, {options.width, options.height},
                  hits);
    vec4 sum(0);
    for (auto hit = hits.begin(); hit != hits.end(); ++hit) {
        const auto isSame = [&](const auto& other) { return isSameTriangle(*hit, other); };
        if (!*hit || std::any_of(hits.begin(), hit, isSame)) continue;
        const float covered = float(std::ranges::count_if(hits, isSame)) / float(options.samples);
        const float share = covered * coverageAt(**hit);
        if (!(share > 0)) continue;
        vec3 radiance = radianceAt(**hit);
        if (bounced) radiance += bouncedRadiance(**hit, uint32_t(y * options.width + x));
        radiance = glm::max(radiance, vec3(0)); // a factored BRDF can be negative
        radiance += asset.pointAt(**hit, camera.eye).emitted;
        if (options.groundFade && options.groundFade->isShadow && options.groundFade->part == (*hit)->mesh)
            sum.w += share * shadowAlpha(radiance, unshadowedRadiance(**hit));
        else
            sum += share * vec4(radiance, 1);
    }
    return sum;
}

// Sums over the unblocked lights above the horizon, tracing shadow rays in batches.
vec3 Renderer::reflectedRadiance(const SurfacePoint& point) const {
    constexpr size_t kBatch = 1024;
    std::array<vec3, kBatch> directions;
    std::array<const LightSample*, kBatch> batch;
    std::array<uint8_t, kBatch> blocked;
    const vec3 origin = point.position + shadowOffset * point.normal;
    glm::dvec3 sum(0);
    for (auto next = lights.begin(); next != lights.end();) {
        size_t count = 0;
        for (; next != lights.end() && count < kBatch; ++next) {
            if (!(glm::dot(next->direction, point.frame.n) > 0)) continue;
            directions[count] = next->direction;
            batch[count++] = &*next;
        }
        occluder.occluded(origin, {directions.data(), count}, {blocked.data(), count});
        for (size_t i = 0; i < count; i++) {
            if (blocked[i]) continue;
            const vec3 incoming = point.frame.toLocal(directions[i]);
            sum += batch[i]->energy * point.reflected(incoming) * incoming.z;
        }
    }
    return vec3(sum);
}

// Computes the residual's estimate from exact sums.
vec3 Renderer::estimateRadiance(const RayHit& hit) const {
    const SurfacePoint point = asset.pointAt(hit, camera.eye), ofTerms = terms->pointAt(hit, camera.eye);
    const bool isMapped = point.frame.n != ofTerms.frame.n;
    const SurfacePoint limit = isMapped ? asset.limitPointAt(hit, camera.eye) : point;
    const bool isRatio = !lightMapSums[hit.mesh].empty();
    const FactoredBrdf& factors = *boundFactors[hit.mesh];
    struct {
        glm::dvec3 exact{0}, most{0}, terms{0}, shadowed{0}, unlit{0}, lit{0};
    } sums[kLightParts]; // by LightPart
    const vec3 origin = point.position + shadowOffset * point.normal;
    for (const LightSample& light : lights) {
        const vec3 seen = point.frame.toLocal(light.direction),
                   incoming = ofTerms.frame.toLocal(light.direction);
        const vec3 found = seen.z > 0 ? seen.z * point.reflected(seen) : vec3(0);
        const bool isAbove = incoming.z > 0;
        vec3 limited(0), f(0), tuples(0);
        if (isAbove) {
            if (isMapped) limited = incoming.z * limit.reflected(incoming);
            f = incoming.z * ofTerms.reflected(incoming);
            tuples = incoming.z * (isRatio ? lookupMap(lightMapSums[hit.mesh].data(), factors.size,
                                                       factors.mapping, incoming)
                                           : vec3(1));
        }
        const bool isLit = isAbove && !occluder.occluded(origin, light.direction);
        for (const LightPart part : {LightPart::Whole, LightPart::Fill}) {
            const vec3 energy = part == LightPart::Whole ? light.energy : light.fill;
            auto& of = sums[size_t(part)];
            of.exact += energy * found;
            of.most += energy * limited;
            of.terms += energy * f;
            of.unlit += energy * tuples;
            if (!isLit) continue;
            of.shadowed += energy * f;
            of.lit += energy * tuples;
        }
    }
    const auto& [whole, fill] = sums;
    vec3 ofFill(fill.exact), ofKey = glm::max(vec3(whole.exact - fill.exact), vec3(0));
    if (isMapped) {
        ofFill = glm::min(ofFill, vec3(fill.most));
        ofKey = glm::min(ofKey, glm::max(vec3(whole.most - fill.most), vec3(0)));
    }
    const auto estimated = [](const auto& of, vec3 exact) {
        return EstimateSums{vec3(of.shadowed), exact,       vec3(of.terms), vec3(of.lit), vec3(of.unlit),
                            vec3(of.shadowed), vec3(of.lit)};
    };
    const EstimateSums own = estimated(fill, ofFill);
    const EstimateSums key = keyOf(estimated(whole, vec3(0)), own, ofKey);
    if (!isRatio) return differenceEstimate(own) + differenceEstimate(key);
    const std::vector<vec3> views =
        pointViews(factors, boundLayersOf[hit.mesh], ofTerms.layerWeights(), ofTerms.outgoing);
    return ratioEstimate(own, vec3(shared::kLeastView)) + ratioEstimate(key, keyLeastView(views));
}

Image render(const Renderer& renderer, const std::function<void(int)>& progress) {
    const ReferenceOptions& options = renderer.options;
    Image image(options.width, options.height);
    std::mutex mutex;
    int finished = 0;
    tbb::parallel_for(0, options.height, [&](int y) {
        for (int x = 0; x < options.width; x++) image.at(x, y) = renderer.pixelAt(x, y);
        if (!progress) return;
        const std::lock_guard lock(mutex);
        progress(++finished);
    });
    return image;
}

std::vector<vec3> sumOfLightMaps(const FactoredBrdf& factors) {
    std::vector<vec3> sum(factors.mapTexels(), vec3(0));
    for (int term = 0; term < factors.terms; term++)
        for (size_t texel = 0; texel < sum.size(); texel++) sum[texel] += factors.lightMap(term)[texel];
    return sum;
}

// Renders an image; `cube` is the light that paths sample.
Image renderUnder(std::vector<LightSample> lights, const LightCube& cube, const Asset& asset,
                  const Camera& camera, const ReferenceOptions& options,
                  const std::function<void(int)>& progress) {
    constexpr int kLargestSide = 16384;
    if (options.width < 1 || options.width > kLargestSide || options.height < 1 ||
        options.height > kLargestSide)
        throw UsageError(fmt::format("a reference image of {} x {} pixels: each side must be 1 to {}",
                                     options.width, options.height, kLargestSide));
    expectSamples(options.samples);
    if (bouncesOf(options, asset) > 0 && options.brdf != ReferenceBrdf::Exact)
        throw UsageError("bounced light is traced with the exact BRDF alone; use --bounces 0");
    const std::vector<const Mesh*> meshes = partMeshes(asset);
    const std::vector<const Mesh*> occluders =
        options.bakedOccluder ? std::vector<const Mesh*>{&asset.occluder} : meshes;
    // On a full mesh the offset only needs to exceed rounding; on a simplified one, its error.
    const float offset =
        options.bakedOccluder ? asset.visibilityOffset : kFullMeshShadowOffset * boundsOf(asset).radius();
    const Appearance appearance = options.appearance.empty() ? defaultAppearance(asset) : options.appearance;
    MaterialBrdfs brdfs;
    const bool isEstimate = options.brdf == ReferenceBrdf::Residual;
    std::optional<BoundAsset> terms;
    std::vector<const FactoredBrdf*> factors;
    std::vector<std::vector<BoundLayer>> layers;
    std::vector<std::vector<vec3>> lightMapSums;
    if (isEstimate) {
        terms.emplace(asset, appearance, ReferenceBrdf::Factored, brdfs);
        for (size_t i = 0; i < asset.parts.size(); i++) {
            factors.push_back(&asset.parts[i].sets[appearance[i].set].brdf);
            layers.push_back(boundLayers(asset.parts[i], appearance[i]));
            lightMapSums.push_back(isNonnegative(*factors[i]) ? sumOfLightMaps(*factors[i])
                                                              : std::vector<vec3>());
        }
    }
    const Renderer renderer{
        camera,
        options,
        std::move(lights),
        BoundAsset(asset, appearance, isEstimate ? ReferenceBrdf::Exact : options.brdf, brdfs),
        std::move(terms),
        std::move(factors),
        std::move(layers),
        std::move(lightMapSums),
        RayTracer(meshes),
        tracerWithout(options.groundFade, camera.eye, meshes),
        RayTracer(occluders),
        offset,
        bouncesOf(options, asset),
        bouncesOf(options, asset) > 0 ? std::optional<LightDistribution>(cube) : std::nullopt,
        meshes};
    return render(renderer, progress);
}

// Returns samples of the lit texels, each divided into side × side equal squares of its face.
std::vector<LightSample> lightSamples(const LightCube& light, int side) {
    std::vector<LightSample> samples;
    const LightCube fill = fillOf(light);
    const int fineSize = light.size * side;
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < fineSize; y++)
            for (int x = 0; x < fineSize; x++) {
                const int texel = cubeTexelIndex(face, x / side, y / side, light.size);
                const vec3 radiance = light.radiance[size_t(texel)];
                if (radiance == vec3(0)) continue;
                const float solidAngle = cubeTexelSolidAngle(x, y, fineSize);
                samples.push_back({cubeTexelDirection(face, x, y, fineSize), radiance * solidAngle,
                                   fill.radiance[size_t(texel)] * solidAngle});
            }
    return samples;
}

// Returns the radiance at which the fill of a latlong map is cut. The mean is over solid angles, while
// fillOf() counts the texels of a cube alike.
float mostOfFill(const Environment& map) {
    double sum = 0, weights = 0;
    for (int row = 0; row < map.height; row++) {
        const double weight = std::sin(double(kPi) * (row + 0.5) / map.height);
        for (int column = 0; column < map.width; column++) {
            const vec3 radiance = map.radiance[size_t(row) * size_t(map.width) + size_t(column)];
            sum += weight * double(std::max({radiance.x, radiance.y, radiance.z, 0.0f}));
            weights += weight;
        }
    }
    return shared::kMostOfMean * float(sum / weights);
}

// Returns a sample per lit pixel of a latlong map, with its exact solid angle: Δlongitude · Δ sin latitude.
std::vector<LightSample> lightSamples(const Environment& map, float rotation) {
    const float cosine = std::cos(rotation), sine = std::sin(rotation);
    const float most = mostOfFill(map);
    std::vector<LightSample> samples;
    for (int row = 0; row < map.height; row++) {
        const double top = double(kPi) * (0.5 - double(row) / map.height);
        const double bottom = double(kPi) * (0.5 - double(row + 1) / map.height);
        const auto solidAngle = float(2.0 * double(kPi) / map.width * (std::sin(top) - std::sin(bottom)));
        for (int column = 0; column < map.width; column++) {
            const vec3 radiance = map.radiance[size_t(row) * size_t(map.width) + size_t(column)];
            if (radiance == vec3(0)) continue;
            const vec3 d = map.direction(float(column) + 0.5f, float(row) + 0.5f);
            const vec3 turned(cosine * d.x + sine * d.z, d.y, cosine * d.z - sine * d.x);
            samples.push_back({turned, radiance * solidAngle, glm::min(radiance, vec3(most)) * solidAngle});
        }
    }
    return samples;
}

} // namespace

Image renderReference(const Asset& asset, const Camera& camera, const LightCube& light,
                      const ReferenceOptions& options, const std::function<void(int)>& progress) {
    constexpr int kMostRays = 16;
    if (options.raysPerTexelSide < 1 || options.raysPerTexelSide > kMostRays)
        throw UsageError(fmt::format("{} shadow rays per side of a lighting texel: must be 1 to {}",
                                     options.raysPerTexelSide, kMostRays));
    return renderUnder(lightSamples(light, options.raysPerTexelSide), light, asset, camera, options,
                       progress);
}

Image renderReference(const Asset& asset, const Camera& camera, const Environment& environment,
                      float rotation, int maxWidth, const ReferenceOptions& options,
                      const std::function<void(int)>& progress) {
    const Environment prepared = prepareForSampling(environment, maxWidth);
    const LightCube cube =
        bouncesOf(options, asset) > 0 ? sampleEnvironment(prepared, kPathFaceSize, rotation) : LightCube();
    return renderUnder(lightSamples(prepared, rotation), cube, asset, camera, options, progress);
}

} // namespace relume
