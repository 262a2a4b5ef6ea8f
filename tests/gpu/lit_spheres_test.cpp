// Lit spheres: the device against the CPU twin, and both against the sum over the light's texels.
#include "engine/light/fill_light.h"
#include "engine/math/cubemap.h"
#include "engine/math/polar_map.h"
#include "engine/math/tangent_frame.h"
#include "engine/render/lit_spheres.h"
#include "engine/render/view_grid.h"
#include "precompute/brdf/brdf.h"
#include "precompute/brdf/factorization.h"
#include "precompute/brdf/tabulation.h"
#include "precompute/residual/residuals.h"
#include "precompute/residual/sphere_kernel.h"
#include "precompute/twins/lit_sphere_twin.h"
#include "tests/support/test_device.h"

#include <cmath>
#include <doctest/doctest.h>
#include <span>

using namespace relume;

namespace {

struct Material {
    std::unique_ptr<Brdf> brdf;
    FactoredBrdf factors;
    Reflectance exact;
};

Material makeMaterial(const char* name, int terms) {
    Material material{makeBrdf(name), {}, {}};
    material.factors =
        factorize(tabulate(*material.brdf, 32, DiskMapping::EqualArea, TexelValue::Mean), {.terms = terms});
    material.exact = [&brdf = *material.brdf](vec3 incoming, vec3 outgoing) {
        return brdf.evaluate(incoming, outgoing);
    };
    return material;
}

std::shared_ptr<ResidualSet> residualOf(const Material& material) {
    auto set = std::make_shared<ResidualSet>();
    set->layers.push_back(makeSphereKernel(material.exact, material.brdf->isIsotropic()));
    set->irradianceWeights = irradianceWeights(material.factors);
    return set;
}

// Parts without a mesh but for a tangent, each of one material.
Asset assetOf(std::initializer_list<const Material*> materials, bool hasTangents) {
    Asset asset;
    for (const Material* material : materials) {
        asset.parts.emplace_back();
        asset.parts.back().sets.push_back({{}, material->factors, {}});
        if (hasTangents) asset.parts.back().mesh.tangents = {{1, 0, 0}};
    }
    return asset;
}

LightCube skyCube() { return sampleEnvironment(prepareForSampling(makeSky()), 64, 0); }

double relativeError(const std::vector<vec3>& values, const std::vector<vec3>& expected) {
    REQUIRE(values.size() == expected.size());
    double difference = 0, total = 0;
    for (size_t i = 0; i < values.size(); i++) {
        difference += double(glm::dot(values[i] - expected[i], values[i] - expected[i]));
        total += double(glm::dot(expected[i], expected[i]));
    }
    return std::sqrt(difference / total);
}

// Unshadowed radiance by the exact BRDF, summed over all texels: of a mirror direction seen from `view`.
vec3 exactRadiance(const LightCube& light, const Brdf& brdf, vec3 view, vec3 mirror) {
    const TangentFrame frame = tangentFrame(glm::normalize(view + mirror));
    glm::dvec3 sum(0);
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < light.size; y++)
            for (int x = 0; x < light.size; x++) {
                const vec3 local = frame.toLocal(cubeTexelDirection(face, x, y, light.size));
                if (local.z > kGrazingCosine)
                    sum += glm::dvec3(local.z * cubeTexelSolidAngle(x, y, light.size) *
                                      brdf.evaluate(local, liftAboveHorizon(frame.toLocal(view))) *
                                      light.radiance[size_t(cubeTexelIndex(face, x, y, light.size))]);
            }
    return vec3(sum);
}

// Returns the relative error of lit spheres about gridDirection(150) under a sky, against the exact radiance
// of mirror directions on every `step`-th azimuth of some rings.
double skyError(const SphereKernel& kernel, const Brdf& brdf, std::span<const uint32_t> rings,
                uint32_t step) {
    const LightCube light = skyCube();
    const vec3 view = gridDirection(150);
    const TangentFrame frame = tangentFrame(view);
    const std::vector<vec3> spheres = litSpheres(kernel, polarLight(sphereCube(light), view));
    std::vector<vec3> made, exact;
    for (const uint32_t ring : rings)
        for (uint32_t azimuth = 0; azimuth < shared::kSphereAzimuths; azimuth += step) {
            const vec3 mirror =
                polarDirection(frame.n, frame.s, (float(ring) + 0.5f) * kPi / float(shared::kSphereRings),
                               float(azimuth) * 2 * kPi / float(shared::kSphereAzimuths));
            const vec3 local = tangentFrame(glm::normalize(view + mirror)).toLocal(view);
            made.push_back(litSphereRadiance(kernel, spheres, ring * shared::kSphereAzimuths + azimuth,
                                             std::atan2(local.y, local.x)));
            exact.push_back(exactRadiance(light, brdf, view, mirror));
        }
    return relativeError(made, exact);
}

} // namespace

TEST_CASE("lit spheres: the device makes those of the twin") {
    const TestDevice device;
    // Samplers round bilinear weights to 8 bits, but lavapipe's.
    const bool isExact = static_cast<const vk::Device&>(device).info().driver.starts_with("llvmpipe");
    const double filtering = isExact ? 2e-3 : 1e-2;
    const LightCube light = skyCube(), fill = fillOf(light);
    REQUIRE(fill.radiance != light.radiance); // there is a sun
    const Material gold = makeMaterial("gold", 5), steel = makeMaterial("brushed-steel", 4);
    const std::shared_ptr<ResidualSet> sets[] = {residualOf(gold), residualOf(steel)};
    CHECK(sets[0]->layers[0]->harmonics == 0);
    CHECK(sets[1]->layers[0]->harmonics > 0);
    LightPass pass(device, 64);
    FillLight fillLight(device, 64);
    pass.setCube(light);
    for (const bool hasTangents : {false, true}) {
        CAPTURE(hasTangents);
        Asset asset = assetOf({&gold, &steel}, hasTangents);
        for (size_t part = 0; part < 2; part++) asset.parts[part].sets[0].residual = sets[part];
        LitSpheres spheres(device, asset, true);
        // More nodes than are made together.
        std::set<uint32_t> nodes;
        for (uint32_t node = 40; node < 80; node++) nodes.insert(node);
        vk::Commands commands(device, "spheres");
        commands.begin();
        pass.record(commands);
        fillLight.record(commands, pass);
        spheres.recordLight(commands, pass, &fillLight);
        const uint32_t both[] = {0, 1};
        spheres.record(commands, both, nodes);
        commands.submitAndWait();

        for (const LightPart lit : {LightPart::Whole, LightPart::Fill}) {
            const LightCube& own = lit == LightPart::Whole ? light : fill;
            const std::vector<vec3> cube = sphereCube(own);
            const std::vector<CellLight> lights = cellLights(own, light);
            for (uint32_t i = 0; i < 2; i++) {
                const SphereKernel& kernel = *sets[i]->layers[0];
                CHECK(relativeError(spheres.readTuples(i, 0, lit),
                                    unshadowedTuples(lights, i == 0 ? gold.factors : steel.factors,
                                                     hasTangents)) < 2e-3);
                const uint32_t node =
                    hasTangents ? 40 : 79; // of the first that are made together, and the last
                CHECK(relativeError(spheres.readSphere(spheres.kernel(&kernel), node, lit),
                                    litSpheres(kernel, polarLight(cube, gridDirection(node)))) < filtering);
            }
        }
    }
}

TEST_CASE("lit spheres: are what the exact BRDF reflects") {
    constexpr uint32_t kRings[] = {2, 6, 10, 14, 18, 22, 26, 30, 34, 38, 42};
    for (const char* name : {"gold", "brushed-steel"}) {
        CAPTURE(std::string(name));
        const Material material = makeMaterial(name, 1);
        const std::shared_ptr<const SphereKernel> kernel =
            makeSphereKernel(material.exact, material.brdf->isIsotropic());
        CHECK(skyError(*kernel, *material.brdf, kRings, 7) < 0.02);
    }
}

TEST_CASE("lit spheres: a strongly brushed metal has no spokes around the point that faces the eye") {
    constexpr uint32_t kRings[] = {0, 3, 6};
    const auto brdf = makeBrdf(R"({"model": "gltf", "metallic": 1, "roughness": 0.3, "anisotropy": 1})");
    const std::shared_ptr<const SphereKernel> kernel = makeSphereKernel(
        [&](vec3 incoming, vec3 outgoing) { return brdf->evaluate(incoming, outgoing); }, false);
    CHECK(skyError(*kernel, *brdf, kRings, 5) < 0.03); // .06 with harmonics to 5
}

TEST_CASE("lit spheres: unshadowed tuples are sums over the light's texels") {
    const LightCube light = skyCube();
    const Material gold = makeMaterial("gold", 8);
    const std::vector<vec3> tuples = unshadowedTuples(cellLights(light, light), gold.factors);
    std::vector<vec3> made, exact;
    for (uint32_t ring = 1; ring < shared::kTupleRings; ring += 5)
        for (uint32_t azimuth = 0; azimuth < shared::kTupleAzimuths; azimuth += 9) {
            const TangentFrame frame = tangentFrame(
                polarDirection({0, 1, 0}, {1, 0, 0}, (float(ring) + 0.5f) * kPi / float(shared::kTupleRings),
                               (float(azimuth) + 0.5f) * 2 * kPi / float(shared::kTupleAzimuths)));
            for (int term = 0; term < gold.factors.terms; term++) {
                glm::dvec3 sum(0);
                for (int face = 0; face < kCubeFaces; face++)
                    for (int y = 0; y < light.size; y++)
                        for (int x = 0; x < light.size; x++) {
                            const vec3 local = frame.toLocal(cubeTexelDirection(face, x, y, light.size));
                            if (local.z > 0)
                                sum += glm::dvec3(
                                    local.z * cubeTexelSolidAngle(x, y, light.size) *
                                    light.radiance[size_t(cubeTexelIndex(face, x, y, light.size))] *
                                    lookupMap(gold.factors.lightMap(term), gold.factors.size,
                                              gold.factors.mapping, local));
                        }
                exact.emplace_back(sum);
                made.push_back(tuples[(ring * shared::kTupleAzimuths + azimuth) * size_t(gold.factors.terms) +
                                      size_t(term)]);
            }
        }
    CHECK(relativeError(made, exact) < 0.02);
}

TEST_CASE("lit spheres: tuples tell irradiance") {
    // Under white light the irradiance of every normal is π.
    const LightCube light{64, std::vector<vec3>(6 * 64 * 64, vec3(1))};
    for (const char* name : {"gold", "brushed-steel", "ashikhmin-shirley"}) {
        CAPTURE(std::string(name));
        const Material material = makeMaterial(name, 6);
        const std::vector<vec3> weights = irradianceWeights(material.factors);
        const std::vector<vec3> tuples = unshadowedTuples(cellLights(light, light), material.factors);
        for (size_t normal = 0; normal < tuples.size() / weights.size(); normal += 97) {
            vec3 irradiance(0);
            for (size_t term = 0; term < weights.size(); term++)
                irradiance += weights[term] * tuples[normal * weights.size() + term];
            CHECK(irradiance.y == doctest::Approx(kPi).epsilon(0.03));
        }
    }
}

TEST_CASE("view grid: every view is mixed of the corners around it") {
    for (int i = 0; i < 500; i++) {
        const float z = 2 * (float(i) + 0.5f) / 500 - 1, azimuth = float(i) * 2.4f;
        const vec3 view(std::sqrt(1 - z * z) * std::cos(azimuth), std::sqrt(1 - z * z) * std::sin(azimuth),
                        z);
        const GridCell cell = gridCell(view);
        vec3 mixed(0);
        for (int corner = 0; corner < 4; corner++)
            mixed += (corner % 2 ? cell.place.x : 1 - cell.place.x) *
                     (corner / 2 ? cell.place.y : 1 - cell.place.y) *
                     gridDirection(cell.nodes[size_t(corner)]);
        CHECK(glm::distance(glm::normalize(mixed), view) < 0.005f);
    }
}
