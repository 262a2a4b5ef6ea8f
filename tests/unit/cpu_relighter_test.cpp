#include "precompute/cpu/cpu_relighter.h"
#include "precompute/twins/relight_twin.h"
#include "tests/support/asset_sample.h"

#include <doctest/doctest.h>

using namespace relume;

TEST_CASE("cpu relighter: every layout gives the reference's bits") {
    std::mt19937 random(4);
    LightCube cube{8, {}};
    for (int i = 0; i < 6 * 8 * 8; i++) // two dark faces
        cube.radiance.push_back(
            i < 256 ? vec3(float(random() % 97), float(random() % 101), float(random() % 103)) : vec3(0));
    const LightVector light = makeLightVector(cube, {.threshold = 500});
    REQUIRE_LT(50, light.indices.size());
    REQUIRE_LT(light.indices.size(), 350); // some columns are not met
    const Transport transports[] = {test::sampleTransport(70, 3, 8, 30, random),
                                    test::sampleBases(300, 3, 8, 70, random)};
    for (const Transport& transport : transports) {
        CAPTURE(layoutName(layoutOf(transport)));
        std::vector<vec3> tuples(size_t(verticesOf(transport)) * termsOf(transport), vec3(-7));
        makeCpuRelighter(transport)->relight(light, tuples);
        CHECK(tuples == relight(transport, light));
    }
}
