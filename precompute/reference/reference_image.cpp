#include "precompute/reference/reference_image.h"

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/math/cubemap.h"
#include "engine/math/tangent_frame.h"
#include "precompute/brdf/brdf.h"
#include "precompute/reference/ray_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

// A direction that light comes from, with radiance · solid angle.
struct LightSample {
    vec3 direction;
    vec3 energy;
};

// f(ωi, ωo) in the local frame of the surface: first ωo, once per pixel, then ωi.
using ReflectedFunction = std::function<vec3(vec3 incoming)>;
using BrdfFunction = std::function<ReflectedFunction(vec3 outgoing)>;

// A layer that a part wears, and its function.
struct WornBrdf {
    WornLayer layer;
    BrdfFunction brdf;
};

struct SurfacePoint {
    size_t part;
    vec3 position;
    TangentFrame frame;
    vec3 outgoing;             // the view direction in the frame, above the horizon
    std::vector<vec3> weights; // of the layers that the part wears
};

// What all pixels share.
struct Renderer {
    const Asset& asset;
    const Camera& camera;
    const ReferenceOptions& options;
    std::vector<LightSample> lights;
    std::vector<std::vector<WornBrdf>> worn; // per part
    std::vector<size_t> materials;           // per part: of its worn set
    RayTracer surfaces;                      // one mesh per part
    RayTracer occluder;
    float shadowOffset;

    std::optional<SurfacePoint> surfaceAt(int x, int y) const;
    std::vector<vec3> weightsAt(size_t part, vec2 uv, vec4 color) const;
    vec3 reflectedRadiance(const SurfacePoint& point) const;
};

std::optional<SurfacePoint> Renderer::surfaceAt(int x, int y) const {
    const auto hit =
        surfaces.intersect(camera.eye, camera.pixelDirection(x, y, options.width, options.height));
    if (!hit) return std::nullopt;
    const Mesh& mesh = asset.parts[hit->mesh].mesh;
    const uvec3 corners = mesh.triangles[hit->triangle];
    const auto interpolate = [&](const auto& values) {
        return hit->weights.x * values[corners.x] + hit->weights.y * values[corners.y] +
               hit->weights.z * values[corners.z];
    };
    const vec3 position = interpolate(mesh.positions);
    const vec3 normal = interpolate(mesh.normals);
    // Opposite normals can cancel out on a fold.
    const bool isCancelled = glm::dot(normal, normal) < 1e-12f;
    const TangentFrame frame = tangentFrame(isCancelled ? mesh.normals[corners.x] : glm::normalize(normal));
    const vec3 outgoing = liftAboveHorizon(frame.toLocal(glm::normalize(camera.eye - position)));
    const vec2 uv = mesh.uvs.empty() ? vec2(0) : interpolate(mesh.uvs);
    const vec4 color = mesh.colors.empty() ? vec4(0) : interpolate(mesh.colors);
    return SurfacePoint{hit->mesh, position, frame, outgoing, weightsAt(hit->mesh, uv, color)};
}

std::vector<vec3> Renderer::weightsAt(size_t part, vec2 uv, vec4 color) const {
    const AssetPart& source = asset.parts[part];
    const vec4 paint =
        paintWeights(source.materialMap ? sample(*source.materialMap, uv) : color, materials[part]);
    std::vector<vec3> weights;
    for (const auto& [layer, brdf] : worn[part]) {
        vec3 weight(layer.weight);
        if (layer.channel >= 0) weight *= paint[layer.channel];
        if (layer.textured) weight *= vec3(sample(*source.baseColor, uv));
        weights.push_back(weight);
    }
    return weights;
}

// Sums over the lights above the horizon that nothing blocks, a batch of shadow rays at a time.
vec3 Renderer::reflectedRadiance(const SurfacePoint& point) const {
    constexpr size_t kBatch = 1024;
    std::array<vec3, kBatch> directions;
    std::array<const LightSample*, kBatch> batch;
    std::array<uint8_t, kBatch> blocked;
    std::vector<ReflectedFunction> brdfs; // of the layers, at this point
    for (const WornBrdf& layer : worn[point.part]) brdfs.push_back(layer.brdf(point.outgoing));
    const auto reflected = [&](vec3 incoming) {
        vec3 f(0);
        for (size_t i = 0; i < brdfs.size(); i++) f += point.weights[i] * brdfs[i](incoming);
        return f;
    };
    const vec3 origin = point.position + shadowOffset * point.frame.n;
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
            sum += batch[i]->energy * reflected(incoming) * incoming.z;
        }
    }
    return vec3(sum);
}

Image render(const Renderer& renderer, const std::function<void(int)>& progress) {
    const ReferenceOptions& options = renderer.options;
    Image image(options.width, options.height);
    std::mutex mutex;
    int finished = 0;
    tbb::parallel_for(0, options.height, [&](int y) {
        for (int x = 0; x < options.width; x++)
            // A factored BRDF can go negative.
            if (const auto point = renderer.surfaceAt(x, y))
                image.at(x, y) = vec4(glm::max(renderer.reflectedRadiance(*point), vec3(0)), 1);
        if (!progress) return;
        const std::lock_guard lock(mutex);
        progress(++finished);
    });
    return image;
}

BrdfFunction exactBrdf(const AssetMaterial& material, const WornLayer& layer) {
    const auto evaluate = [&]() -> vec3 (*)(const Brdf&, vec3, vec3) {
        if (layer.textured)
            return [](const Brdf& brdf, vec3 incoming, vec3 outgoing) {
                return brdf.evaluateBase(incoming, outgoing);
            };
        if (material.hasBase)
            return [](const Brdf& brdf, vec3 incoming, vec3 outgoing) {
                return brdf.evaluate(incoming, outgoing) - brdf.evaluateBase(incoming, outgoing);
            };
        return
            [](const Brdf& brdf, vec3 incoming, vec3 outgoing) { return brdf.evaluate(incoming, outgoing); };
    }();
    return [evaluate, brdf = std::shared_ptr<const Brdf>(makeBrdf(material.description))](vec3 outgoing) {
        return
            [evaluate, &brdf = *brdf, outgoing](vec3 incoming) { return evaluate(brdf, incoming, outgoing); };
    };
}

BrdfFunction factoredBrdf(const FactoredBrdf& brdf, int layer) {
    return [&brdf, layer](vec3 outgoing) {
        std::vector<vec3> views; // one per term
        for (int term = 0; term < brdf.terms; term++)
            views.push_back(lookupMap(brdf.viewMap(layer, term), brdf.size, brdf.mapping, outgoing));
        return [&brdf, views](vec3 incoming) {
            vec3 sum(0);
            for (int term = 0; term < brdf.terms; term++)
                sum +=
                    views[size_t(term)] * lookupMap(brdf.lightMap(term), brdf.size, brdf.mapping, incoming);
            return sum;
        };
    };
}

const AssetMaterial& materialOf(const MaterialSet& set, int layer) {
    return *std::find_if(set.materials.begin(), set.materials.end(), [&](const AssetMaterial& material) {
        return layer >= material.layer && layer < material.layer + material.layers();
    });
}

std::vector<WornBrdf> wornBrdfs(const AssetPart& part, const PartAppearance& appearance, ReferenceBrdf kind) {
    const MaterialSet& set = part.sets.at(appearance.set);
    std::vector<WornBrdf> worn;
    for (const WornLayer& layer : wornLayers(part, appearance))
        worn.push_back({layer, kind == ReferenceBrdf::Exact ? exactBrdf(materialOf(set, layer.layer), layer)
                                                            : factoredBrdf(set.brdf, layer.layer)});
    return worn;
}

std::vector<const Mesh*> partMeshes(const Asset& asset) {
    std::vector<const Mesh*> meshes;
    for (const AssetPart& part : asset.parts) meshes.push_back(&part.mesh);
    return meshes;
}

Image renderUnder(std::vector<LightSample> lights, const Asset& asset, const Camera& camera,
                  const ReferenceOptions& options, const std::function<void(int)>& progress) {
    constexpr int kLargestSide = 16384;
    if (options.width < 1 || options.width > kLargestSide || options.height < 1 ||
        options.height > kLargestSide)
        throw UsageError("a reference image of {} x {} pixels: each side must be 1 to {}", options.width,
                         options.height, kLargestSide);
    const std::vector<const Mesh*> meshes = partMeshes(asset);
    const std::vector<const Mesh*> occluders =
        options.bakedOccluder ? std::vector<const Mesh*>{&asset.occluder} : meshes;
    // A full mesh needs no more than to clear rounding; a simplified one must clear its own error.
    const float offset =
        options.bakedOccluder ? asset.visibilityOffset : kFullMeshShadowOffset * boundsOf(asset).radius();
    const Appearance appearance = options.appearance.empty() ? defaultAppearance(asset) : options.appearance;
    RELUME_CHECK_EQ(appearance.size(), asset.parts.size());
    std::vector<std::vector<WornBrdf>> worn;
    std::vector<size_t> materials;
    for (size_t i = 0; i < asset.parts.size(); i++) {
        worn.push_back(wornBrdfs(asset.parts[i], appearance[i], options.brdf));
        materials.push_back(asset.parts[i].sets[appearance[i].set].materials.size());
    }
    const Renderer renderer{asset,
                            camera,
                            options,
                            std::move(lights),
                            std::move(worn),
                            std::move(materials),
                            RayTracer(meshes),
                            RayTracer(occluders),
                            offset};
    return render(renderer, progress);
}

// Each lit texel as side × side equal squares of its face.
std::vector<LightSample> lightSamples(const LightCube& light, int side) {
    std::vector<LightSample> samples;
    const int fineSize = light.size * side;
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < fineSize; y++)
            for (int x = 0; x < fineSize; x++) {
                const int texel = cubeTexelIndex(face, x / side, y / side, light.size);
                const vec3 radiance = light.radiance[size_t(texel)];
                if (radiance == vec3(0)) continue;
                samples.push_back({cubeTexelDirection(face, x, y, fineSize),
                                   radiance * cubeTexelSolidAngle(x, y, fineSize)});
            }
    return samples;
}

// Each lit pixel of a latlong map, with its exact solid angle: Δlongitude · Δ sin latitude.
std::vector<LightSample> lightSamples(const Environment& map, float rotation) {
    const float cosine = std::cos(rotation), sine = std::sin(rotation);
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
            samples.push_back({turned, radiance * solidAngle});
        }
    }
    return samples;
}

} // namespace

Image renderReference(const Asset& asset, const Camera& camera, const LightCube& light,
                      const ReferenceOptions& options, const std::function<void(int)>& progress) {
    constexpr int kMostRays = 16;
    if (options.raysPerTexelSide < 1 || options.raysPerTexelSide > kMostRays)
        throw UsageError("{} shadow rays per side of a lighting texel: must be 1 to {}",
                         options.raysPerTexelSide, kMostRays);
    return renderUnder(lightSamples(light, options.raysPerTexelSide), asset, camera, options, progress);
}

Image renderReference(const Asset& asset, const Camera& camera, const Environment& environment,
                      float rotation, int maxWidth, const ReferenceOptions& options,
                      const std::function<void(int)>& progress) {
    const Environment prepared = prepareForSampling(environment, maxWidth);
    return renderUnder(lightSamples(prepared, rotation), asset, camera, options, progress);
}

} // namespace relume
