#include "engine/math/tangent_frame.h"
#include "engine/render/view_pass.h"
#include "engine/scene/builtin_mesh.h"
#include "precompute/reference/ray_tracer.h"
#include "precompute/reference/transport_stages.h"
#include "tests/support/test_device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

using namespace relume;

namespace {

// Any mesh with random view maps of both signs and a few random entries a row.
AssetPart makePart(Mesh mesh, int terms, DiskMapping mapping, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(-1, 1);
    AssetPart part;
    part.name = "test";
    part.sets.emplace_back().materials = {{"test", "{}"}};
    part.mesh = std::move(mesh);
    part.sets[0].brdf.size = 8;
    part.sets[0].brdf.terms = terms;
    part.sets[0].brdf.mapping = mapping;
    for (size_t i = 0; i < size_t(terms) * part.sets[0].brdf.mapTexels(); i++)
        part.sets[0].brdf.viewMaps.emplace_back(value(random), value(random), value(random));
    SparseTransport& transport = part.sets[0].transport;
    transport.vertices = uint32_t(part.mesh.vertexCount());
    transport.terms = uint32_t(terms);
    transport.rowStarts.push_back(0);
    for (size_t row = 0; row < transport.rows(); row++) {
        transport.scales.push_back(1 + value(random) / 2);
        for (int e = 0; e < 3; e++) {
            transport.indices.push_back(uint16_t(random() % (6 * 64 * 64)));
            transport.values.push_back(random());
        }
        transport.rowStarts.push_back(transport.values.size());
    }
    return part;
}

Asset makeAsset(int firstTerms, int secondTerms) {
    Asset asset;
    Mesh plane = makePlane(4, 3);
    for (vec3& position : plane.positions) position.y -= 0.5f; // cuts the sphere
    asset.parts.push_back(makePart(makeSphere(2), firstTerms, DiskMapping::Orthographic, 1));
    asset.parts.push_back(makePart(plane, secondTerms, DiskMapping::Polar, 2));
    return asset;
}

LightCube makeLight() {
    std::mt19937 random(3);
    LightCube cube{64, {}};
    for (int i = 0; i < 6 * 64 * 64; i++)
        cube.radiance.emplace_back(float(random() % 997), float(random() % 1009), float(random() % 1013));
    return cube;
}

struct HostPixel {
    bool covered;
    bool steady; // away from edges and grazing angles, where rounding decides
    vec3 radiance;
};

// Radiance in a direction from the eye, by ray tracing and the definitions of section 9 of the method.
class HostView {
  public:
    HostView(const Asset& asset, const LightVector& light)
        : mAsset(asset), mLight(light), mTracer(std::array{&asset.parts[0].mesh, &asset.parts[1].mesh}) {
        for (const AssetPart& part : asset.parts) mSums.push_back(relight(part.sets[0].transport, light));
    }

    HostPixel at(vec3 eye, vec3 direction) const {
        const auto hit = mTracer.intersect(eye, direction);
        if (!hit) return {false, false, vec3(0)};
        const AssetPart& part = mAsset.parts[hit->mesh];
        const uvec3 corners = part.mesh.triangles[hit->triangle];
        vec3 normal(0), position(0);
        for (int c = 0; c < 3; c++) {
            normal += hit->weights[c] * part.mesh.normals[corners[c]];
            position += hit->weights[c] * part.mesh.positions[corners[c]];
        }
        const vec3 toEye = tangentFrame(glm::normalize(normal)).toLocal(glm::normalize(eye - position));
        const vec3 local = liftAboveHorizon(toEye);
        vec3 radiance(0);
        for (int term = 0; term < part.sets[0].brdf.terms; term++) {
            vec3 tuple(0);
            for (int c = 0; c < 3; c++) tuple += hit->weights[c] * tupleOf(hit->mesh, corners[c], term);
            radiance +=
                tuple * lookupMap(&part.sets[0].brdf.viewMaps[size_t(term) * part.sets[0].brdf.mapTexels()],
                                  part.sets[0].brdf.size, part.sets[0].brdf.mapping, local);
        }
        const float inside = std::min({hit->weights.x, hit->weights.y, hit->weights.z});
        return {true, inside > 0.02f && toEye.z > 0.15f, glm::max(radiance, vec3(0))};
    }

  private:
    vec3 tupleOf(size_t part, uint32_t vertex, int term) const {
        const SparseTransport& transport = mAsset.parts[part].sets[0].transport;
        const size_t row = size_t(vertex) * transport.terms + size_t(term);
        return vec3(mSums[part][row]) * transport.scales[row] * mLight.scale /
               vec3(kRedMaximum, kGreenMaximum, kBlueMaximum);
    }

    const Asset& mAsset;
    const LightVector& mLight;
    RayTracer mTracer;
    std::vector<std::vector<ivec3>> mSums;
};

struct TestScene {
    TestScene(const vk::Device& device, const Asset& asset)
        : light(device, asset.faceSize), relighter(device, asset) {
        light.setCube(makeLight());
        vk::Commands commands(device, "view test");
        commands.begin();
        light.record(commands, 0, 0);
        relighter.record(commands, light);
        commands.submitAndWait();
    }
    LightPass light;
    Relighter relighter;
};

void checkAgainstHost(const vk::Device& device, const Asset& asset, uint32_t termsPerDraw) {
    const TestScene scene(device, asset);
    const LightVector light = scene.light.readVector();
    constexpr int kWidth = 120, kHeight = 80;
    const ViewPass view(device, asset, {.width = kWidth, .height = kHeight, .termsPerDraw = termsPerDraw});
    const Camera camera = orbitCamera(boundsOf(asset), 0.5f, 0.6f, 0.7f, 0.8f, float(kWidth) / kHeight);
    const Image image = view.render(camera, scene.relighter, scene.light);
    REQUIRE_EQ(image.width, kWidth);
    REQUIRE_EQ(image.height, kHeight);

    const HostView host(asset, light);
    std::vector<HostPixel> expected;
    for (int y = 0; y < kHeight; y++)
        for (int x = 0; x < kWidth; x++)
            expected.push_back(host.at(camera.eye, camera.pixelDirection(x, y, kWidth, kHeight)));

    float largest = 0, worst = 0;
    int covered = 0, clamped = 0;
    for (int y = 1; y + 1 < kHeight; y++)
        for (int x = 1; x + 1 < kWidth; x++) {
            const HostPixel* here = &expected[size_t(y * kWidth + x)];
            const bool beside =
                here[-1].covered || here[1].covered || here[-kWidth].covered || here[kWidth].covered;
            if (!here->covered && beside) continue;
            if (here->covered && !here->steady) continue;
            const vec4 pixel = image.at(x, y);
            CHECK_EQ(pixel.w, here->covered ? 1.0f : 0.0f);
            covered += here->covered;
            for (int c = 0; c < 3; c++) {
                CHECK_LE(0.0f, pixel[c]);
                largest = std::max(largest, here->radiance[c]);
                worst = std::max(worst, std::abs(pixel[c] - here->radiance[c]));
                clamped += here->covered && here->radiance[c] == 0;
            }
        }
    CHECK_LT(worst, 1e-4f * largest);
    CHECK_LT(kWidth * kHeight / 4, covered);
    CHECK_LT(100, clamped);
}

} // namespace

TEST_CASE("view pass: agrees with the CPU at every number of terms") {
    const TestDevice device;
    checkAgainstHost(device, makeAsset(4, 1), 0);
    checkAgainstHost(device, makeAsset(32, 7), 0);
}

TEST_CASE("view pass: terms over several draws add up, and are clamped after the last") {
    const TestDevice device;
    checkAgainstHost(device, makeAsset(5, 2), 2);
    checkAgainstHost(device, makeAsset(3, 4), 1);
}

TEST_CASE("view pass: a diffuse plane seen from above is its tuple") {
    const TestDevice device;
    Asset asset;
    asset.parts.push_back(makePart(makePlane(2, 1), 1, DiskMapping::Orthographic, 4));
    AssetPart& part = asset.parts[0];
    std::fill(part.sets[0].brdf.viewMaps.begin(), part.sets[0].brdf.viewMaps.end(), vec3(0.5f));
    // One entry a row: the average of face 2 (+Y), 64 times its constant radiance of 3.
    part.sets[0].transport.indices.assign(4, 2 * 4096);
    part.sets[0].transport.values.assign(4, packCoefficient({1023, 512, 0}));
    part.sets[0].transport.scales.assign(4, 2.0f);
    part.sets[0].transport.rowStarts = {0, 1, 2, 3, 4};
    LightPass light(device, 64);
    LightCube cube{64, std::vector<vec3>(6 * 4096, vec3(0))};
    std::fill_n(cube.radiance.begin() + 2 * 4096, 4096, vec3(3));
    light.setCube(cube);
    const Relighter relighter(device, asset);
    ViewPass view(device, asset, {.width = 16, .height = 8});
    vk::Commands commands(device, "view test");
    commands.begin();
    light.record(commands);
    relighter.record(commands, light);
    view.record(commands, {{0, 3, 0}, {0, 0, 0}, 1.2f}, relighter, light);
    commands.submitAndWait();
    const Image image = view.read();
    CHECK_EQ(image.at(8, 4).x, doctest::Approx(0.5 * 2 * 3 * 64));
    CHECK_EQ(image.at(8, 4).y, doctest::Approx(0.5 * 2 * 3 * 64 * 512 / 1023));
    CHECK_EQ(image.at(8, 4).z, 0);
    CHECK_EQ(image.at(8, 4).w, 1);
    CHECK(image.at(0, 0) == vec4(0)); // the plane ends before the border

    view.resize(30, 20);
    CHECK_EQ(view.render({{0, 3, 0}, {0, 0, 0}, 1.2f}, relighter, light).at(15, 10).x,
             doctest::Approx(0.5 * 2 * 3 * 64));
}
