// Tests cluster culling against the triangles themselves.
#include "engine/render/triangle_clusters.h"

#include "engine/import/builtin_mesh.h"
#include "engine/scene/camera.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace relume;

namespace {

constexpr float kAspect = 1.5f, kFov = 0.8f, kViewHeight = 400;

ClusterView viewOf(const Camera& camera, const Mesh& mesh, bool hidesBacks) {
    const float focalLength = 0.5f * kViewHeight / std::tan(0.5f * camera.verticalFov);
    return {camera.clipFromWorld(kAspect, boundsOf(mesh)), camera.eye, focalLength, 1.0f / 256, hidesBacks};
}

uint32_t counted(const std::vector<TriangleRun>& runs) {
    uint32_t count = 0;
    for (const TriangleRun& run : runs) count += run.count;
    return count;
}

// Whether some plane of the frustum has all corners behind it.
bool isOutside(const Mesh& mesh, uvec3 triangle, const mat4& clipFromWorld) {
    vec4 clip[3];
    for (int c = 0; c < 3; c++) clip[c] = clipFromWorld * vec4(mesh.positions[triangle[c]], 1);
    const auto all = [&](auto&& behind) { return std::ranges::all_of(clip, behind); };
    return all([](vec4 p) { return p.x < -p.w; }) || all([](vec4 p) { return p.x > p.w; }) ||
           all([](vec4 p) { return p.y < -p.w; }) || all([](vec4 p) { return p.y > p.w; }) ||
           all([](vec4 p) { return p.z < 0; }) || all([](vec4 p) { return p.z > p.w; });
}

bool isBack(const Mesh& mesh, uvec3 triangle, vec3 eye) {
    const vec3 a = mesh.positions[triangle.x], b = mesh.positions[triangle.y], c = mesh.positions[triangle.z];
    return glm::dot(glm::cross(b - a, c - a), a - eye) > 0;
}

// Of a mesh's triangles those that are drawn; every other one is seen to be invisible.
uint32_t checkedCount(const Mesh& mesh, const Camera& camera, bool hidesBacks) {
    const ClusterView view = viewOf(camera, mesh, hidesBacks);
    const std::vector<TriangleRun> runs = TriangleClusters(mesh).visible(view);
    std::vector<bool> drawn(mesh.triangleCount(), false);
    uint32_t end = 0;
    for (const TriangleRun& run : runs) {
        CHECK_LE(end, run.first);
        CHECK_LT(0u, run.count);
        end = run.first + run.count;
        REQUIRE_LE(end, mesh.triangleCount());
        std::fill_n(drawn.begin() + run.first, run.count, true);
    }
    for (size_t t = 0; t < mesh.triangleCount(); t++) {
        const uvec3 triangle = mesh.triangles[t];
        if (!drawn[t])
            CHECK((isOutside(mesh, triangle, view.clipFromWorld) ||
                   (hidesBacks && isBack(mesh, triangle, camera.eye))));
    }
    return counted(runs);
}

} // namespace

TEST_CASE("triangle clusters: backs are left out where they are hidden, and nothing else from outside") {
    const Mesh sphere = makeSphere(5);
    const auto all = uint32_t(sphere.triangleCount());
    for (float azimuth : {0.0f, 1.0f, 2.5f}) {
        const Camera camera = orbitCamera(boundsOf(sphere), azimuth, 0.4f, 1.3f, kFov, kAspect);
        CHECK_EQ(checkedCount(sphere, camera, false), all);
        const uint32_t fronts = checkedCount(sphere, camera, true);
        CHECK_LT(fronts, all * 7 / 10);
        CHECK_LT(all / 4, fronts);
    }
}

TEST_CASE("triangle clusters: what is beside, behind or beyond the frustum is left out") {
    const Mesh plane = makePlane(2, 64);
    const auto all = uint32_t(plane.triangleCount());
    const Mesh sphere = makeSphere(5);
    CHECK_LT(checkedCount(sphere, {{0, 0.2f, 1.5f}, {0, 0, 0}, 0.2f}, false), sphere.triangleCount() / 4);
    CHECK_LT(checkedCount(plane, {{0, 0.05f, 0}, {1, 0.05f, 0.3f}, kFov}, false), all / 2);
    CHECK_EQ(checkedCount(plane, {{5, 5, 5}, {9, 9, 9}, kFov}, false), 0);
    CHECK_EQ(TriangleClusters(Mesh{}).visible(viewOf({{0, 0, 4}, {0, 0, 0}, kFov}, plane, true)).size(), 0);
}

TEST_CASE("triangle clusters: from inside a sphere what is around is drawn") {
    const Mesh sphere = makeSphere(4);
    CHECK_LT(sphere.triangleCount() / 4, checkedCount(sphere, {{0, 0, 0}, {0, 0, -1}, 3.0f}, false));
}

TEST_CASE("triangle clusters: what rounding could turn to the front is drawn") {
    // Seen at a grazing angle from behind: 5e-4 of a unit's depth over a unit, a pixel being 2e-3.
    Mesh plane = makePlane(1, 4);
    const Camera above{{0, 0, 2}, {0, 0, 0}, kFov};
    for (vec3& position : plane.positions) position.y = -1e-5f;
    const Camera below{{0, -4e-5f, 3}, {0, 0, 0}, kFov};
    CHECK_EQ(checkedCount(plane, below, true), plane.triangleCount());
    const Camera farBelow{{0, -1, 3}, {0, 0, 0}, kFov};
    CHECK_EQ(checkedCount(plane, farBelow, true), 0);
    CHECK_EQ(checkedCount(plane, above, true), plane.triangleCount());
}
