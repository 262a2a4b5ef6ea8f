#include "engine/render/ground_fade.h"

#include "engine/import/builtin_mesh.h"
#include "tests/support/diffuse_asset.h"

#include <doctest/doctest.h>

using namespace relume;
using namespace relume::test;

TEST_CASE("ground fade: a ground shows its shadow if it is flat, from above") {
    Mesh plane = makePlane(4, 4);
    for (vec3& position : plane.positions) position.y -= 0.5f;
    Asset asset =
        makeTestAsset({makeDiffusePart(makeTorus(1, 0.4f, 12, 8), 0.5f), makeDiffusePart(plane, 0.5f)});
    CHECK_FALSE(makeGroundFade(asset, GroundStyle::Shadow));
    asset.parts[1].name = "ground";
    CHECK_FALSE(makeGroundFade(asset, GroundStyle::Whole));
    CHECK_FALSE(makeGroundFade(asset, GroundStyle::Fade)->isShadow);
    const GroundFade flat = *makeGroundFade(asset, GroundStyle::Shadow);
    CHECK(flat.isShadow);
    CHECK_FALSE(flat.isHiddenFrom({0, 1, 0}));
    CHECK(flat.isHiddenFrom({0, -1, 0}));
    asset.parts[1].mesh.positions[0].y += 0.5f;
    const GroundFade hill = *makeGroundFade(asset, GroundStyle::Shadow);
    CHECK_FALSE(hill.isShadow);
    CHECK_FALSE(hill.isHiddenFrom({0, -1, 0}));
    // Light that errors of transport alone can lose is no shadow.
    CHECK(shadowAlpha(vec3(0.98f), vec3(1)) == 0);
    CHECK(shadowAlpha(vec3(0), vec3(1)) == 1);
    CHECK(shadowAlpha(vec3(2), vec3(1)) == 0);
    CHECK(shadowAlpha(vec3(0), vec3(0)) == 0);
}
