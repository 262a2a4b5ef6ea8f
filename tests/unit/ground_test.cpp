#include "engine/import/builtin_mesh.h"

#include "engine/base/error.h"
#include "engine/import/scene.h"

#include <doctest/doctest.h>

using namespace relume;

TEST_CASE("ground: under the object's lowest point, centered, in its units") {
    Bounds object;
    object.add({1, 5, -2});
    object.add({3, 9, -1}); // the largest extent is 4, upwards
    const Mesh ground = makeGround(object);
    CHECK(ground.vertexCount() == 22201); // the paper's ground for the bunny
    const Bounds bounds = boundsOf(ground);
    CHECK(bounds.low.y == 5.0f);
    CHECK(bounds.high.y == 5.0f);
    CHECK(bounds.extent().x == doctest::Approx(12));
    CHECK(bounds.extent().z == doctest::Approx(12));
    CHECK(bounds.center().x == doctest::Approx(2));
    CHECK(bounds.center().z == doctest::Approx(-1.5));
    for (const vec3& normal : ground.normals) CHECK(normal == vec3(0, 1, 0));
}

TEST_CASE("ground: options out of range are refused") {
    Scene scene{{{"ball", makeSphere(1), "clay", "", ""}}};
    CHECK_THROWS_AS(addGround(scene, {0, 3}), UsageError);
    CHECK_THROWS_AS(addGround(scene, {100000, 3}), UsageError);
    CHECK_THROWS_AS(addGround(scene, {10, 0}), UsageError);
    CHECK_THROWS_AS(addGround(scene, {10, NAN}), UsageError);
    addGround(scene, {10, 2});
    REQUIRE(scene.parts.size() == 2);
    CHECK(scene.parts[1].material == "white-diffuse");
    CHECK(scene.parts[1].mesh.vertexCount() == 121);
}
