// Balls of materials.
#include "apps/viewer/swatch.h"

#include "precompute/brdf/brdf.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace relume;

TEST_CASE("swatch: is a ball in its material's color, lit from above") {
    constexpr int kSide = 48;
    const Image ball = renderSwatch("red-plastic", kSide);
    CHECK_EQ(ball.width, kSide);
    CHECK_EQ(ball.height, kSide);
    vec3 upper(0), lower(0);
    int covered = 0;
    for (int y = 0; y < kSide; y++)
        for (int x = 0; x < kSide; x++) {
            const vec4 pixel = ball.at(x, y);
            const vec2 place = (vec2(x, y) + 0.5f) / (0.5f * kSide) - 1.0f;
            CHECK_EQ(pixel.w, glm::length(place) < 1 ? 1 : 0);
            covered += pixel.w > 0;
            (y < kSide / 2 ? upper : lower) += vec3(pixel);
        }
    CHECK(covered == doctest::Approx(kPi / 4 * kSide * kSide).epsilon(0.03));
    const vec3 sum = upper + lower;
    CHECK_GT(sum.x, 1.5f * sum.y);
    CHECK_GT(sum.x, 1.5f * sum.z);
    CHECK_GT(upper.x, lower.x);
    CHECK_GT(lower.x, 0);

    // By the description that a bake keeps, the same.
    const Image kept = renderSwatch(makeBrdf("red-plastic")->describe().dump(), kSide);
    CHECK(kept.pixels == ball.pixels);
    const vec4 gray = renderSwatch("white-diffuse", kSide).at(kSide / 2, kSide / 2);
    CHECK(gray.x == doctest::Approx(gray.y).epsilon(0.5));
}
