// The light's fill: the device against the CPU twins, to the bit.
#include "engine/import/builtin_mesh.h"
#include "engine/import/scene.h"
#include "engine/light/fill_light.h"
#include "engine/light/light.h"
#include "engine/render/fill_light.h"
#include "engine/render/relighter.h"
#include "precompute/bake/bake.h"
#include "precompute/twins/relight_twin.h"
#include "tests/support/test_device.h"

#include <doctest/doctest.h>

using namespace relume;

namespace {

LightCube cubeOf(int size, vec3 even) {
    return {size, std::vector<vec3>(6 * size_t(size) * size_t(size), even)};
}

// An even sky with a sun, and with texels that are negative or black.
LightCube sunnyCube(int size) {
    LightCube cube = cubeOf(size, {0.3f, 0.5f, 0.9f});
    cube.radiance[size_t(size) + 3] = {5000, 4000, 30};
    cube.radiance[7] = {-2, 0.1f, 0};
    cube.radiance[8] = vec3(0);
    return cube;
}

LightCube skyCube(int size) { return sampleEnvironment(prepareForSampling(makeSky()), size, 0.3f); }

void record(const vk::Device& device, LightPass& light, const std::function<void(vk::Commands&)>& rest) {
    vk::Commands commands(device, "fill test");
    commands.begin();
    light.record(commands);
    rest(commands);
    commands.submitAndWait();
}

} // namespace

TEST_CASE("fill light: what is bright is cut, and nothing else") {
    const LightCube cube = sunnyCube(32), fill = fillOf(cube);
    const float mean = (0.9f * (6 * 32 * 32 - 3) + 5000 + 0.1f) / (6 * 32 * 32);
    CHECK(fill.radiance[35].x == doctest::Approx(10 * mean));
    CHECK(fill.radiance[35].y == fill.radiance[35].x);
    for (size_t texel = 0; texel < cube.radiance.size(); texel++)
        if (texel != 35) CHECK(fill.radiance[texel] == cube.radiance[texel]);
    CHECK(fillOf(cubeOf(32, vec3(3))).radiance == cubeOf(32, vec3(3)).radiance);
    CHECK(fillOf(cubeOf(32, vec3(0))).radiance == cubeOf(32, vec3(0)).radiance);
}

TEST_CASE("fill light: the device makes that of the twin, and its entries") {
    const TestDevice device;
    for (const int size : {32, 64})
        for (const LightCube& cube : {sunnyCube(size), skyCube(size), cubeOf(size, vec3(0))}) {
            LightPass light(device, size);
            FillLight fill(device, size);
            light.setCube(cube);
            record(device, light, [&](vk::Commands& commands) { fill.record(commands, light); });
            const LightCube expected = fillOf(cube);
            CHECK(fill.readCube().radiance == expected.radiance);
            const LightVector vector = makeLightVector(expected), found = fill.table().readVector();
            CHECK(found.scale == vector.scale);
            CHECK(found.indices == vector.indices);
            CHECK(found.values == vector.values);
            CHECK(light.readVector().values ==
                  makeLightVector(cube).values); // the whole light is what it was
        }
}

TEST_CASE("fill light: sets with a residual have its tuples, in every layout, from changes too") {
    const TestDevice device;
    for (const TransportLayout layout : {TransportLayout::Rows, TransportLayout::Bases}) {
        Scene scene;
        scene.parts.push_back({"knot", makeKnot(600), "gold", "built-in knot", ""});
        scene.parts.push_back({"ground", makePlane(4, 4), "white-diffuse", "built-in plane", ""});
        BakeOptions options;
        options.factorization.terms = 3;
        options.faceSize = 32;
        options.visibilitySize = 64;
        options.mapSize = 24;
        options.layout.layout = layout;
        options.coefficients = 96;
        const Asset asset = bake(device, std::move(scene), options);
        LightPass light(device, asset.faceSize);
        Relighter relighter(device, asset), alone(device, asset, {.residual = false});
        for (const LightCube& cube : {skyCube(asset.faceSize), sunnyCube(asset.faceSize)}) {
            light.setCube(cube);
            record(device, light, [&](vk::Commands& commands) { relighter.record(commands, light); });
            const LightVector whole = makeLightVector(cube), fill = makeLightVector(fillOf(cube));
            const Transport& glossy = asset.parts[0].sets[0].transport;
            CHECK(relighter.readTuples(0) == relight(glossy, whole));
            CHECK(relighter.readFillTuples(0) == relight(glossy, fill));
            // Diffuse sets have no residual, and need none.
            CHECK(relighter.readFillTuples(1) == relighter.readTuples(1));
        }
        CHECK(&alone.fillTuples(0, 0) == &alone.tuples(0));

        relighter.setMode(RelightMode::Incremental);
        LightCube cube = sunnyCube(asset.faceSize);
        for (size_t step = 0; step < 8; step++) {
            cube.radiance[500 + 40 * step] += vec3(0.25f); // far below the sun, which decides the scale
            light.setCube(cube);
            record(device, light, [&](vk::Commands& commands) { relighter.record(commands, light); });
            CHECK(relighter.readFillTuples(0) ==
                  relight(asset.parts[0].sets[0].transport, makeLightVector(fillOf(cube))));
        }
    }
}
