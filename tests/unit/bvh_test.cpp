// Tests the bounding volume hierarchy: it holds every triangle, and boxes contain their descendants.
#include "engine/import/builtin_mesh.h"
#include "precompute/visibility/bvh.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <tuple>

using namespace relume;

namespace {

using Triangle = std::array<vec4, 3>;

// The triangles below a node, all of which must lie in the boxes on the way to them.
void collect(const Bvh& bvh, uint32_t node, uint32_t depth, std::vector<Triangle>& found, uint32_t& deepest) {
    deepest = std::max(deepest, depth);
    for (uint32_t slot = 0; slot < shared::kBvhWidth; slot++) {
        const shared::BvhChild& child = bvh.children[node * shared::kBvhWidth + slot];
        if (!(child.low.x <= child.high.x)) continue;
        const size_t before = found.size();
        if ((child.entry & shared::kBvhLeaf) != 0) {
            const uint32_t first = child.entry & ((1u << shared::kBvhCountShift) - 1);
            const uint32_t count = (child.entry >> shared::kBvhCountShift & 31) + 1;
            REQUIRE_LE(count, shared::kBvhWidth); // a lane each
            REQUIRE_LE(first + count, bvh.triangles.size());
            for (uint32_t i = 0; i < count; i++) found.push_back(bvh.triangles[first + i]);
        } else {
            REQUIRE_LT(child.entry, bvh.children.size() / shared::kBvhWidth);
            collect(bvh, child.entry, depth + 1, found, deepest);
        }
        bool inside = true;
        for (size_t i = before; i < found.size(); i++)
            for (const vec4& corner : found[i])
                inside = inside && glm::all(glm::greaterThanEqual(vec3(corner), child.low)) &&
                         glm::all(glm::lessThanEqual(vec3(corner), child.high));
        CHECK(inside);
    }
}

bool isLess(const Triangle& a, const Triangle& b) {
    const auto key = [](const Triangle& t) {
        return std::tie(t[0].x, t[0].y, t[0].z, t[1].x, t[1].y, t[1].z, t[2].x, t[2].y, t[2].z);
    };
    return key(a) < key(b);
}

} // namespace

TEST_CASE("bvh: holds every triangle once, within its boxes") {
    Mesh one;
    one.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    one.triangles = {{0, 1, 2}};
    Mesh same = one; // Embree cannot tell these apart
    for (int i = 0; i < 100; i++) same.triangles.push_back({0, 1, 2});
    for (const Mesh& mesh : {makeKnot(3000), makeSphere(4), one, same}) {
        const Bvh bvh = buildBvh(mesh);
        std::vector<Triangle> found, expected;
        uint32_t deepest = 0;
        collect(bvh, 0, 1, found, deepest);
        CHECK_EQ(deepest, bvh.depth);
        for (const uvec3& t : mesh.triangles)
            expected.push_back(
                {vec4(mesh.positions[t.x], 0), vec4(mesh.positions[t.y], 0), vec4(mesh.positions[t.z], 0)});
        std::ranges::sort(found, isLess);
        std::ranges::sort(expected, isLess);
        CHECK(found == expected);
    }
}

TEST_CASE("bvh: the same mesh gives the same hierarchy") {
    const Mesh knot = makeKnot(20'000);
    const Bvh once = buildBvh(knot), again = buildBvh(knot);
    CHECK(once.triangles == again.triangles);
    CHECK(std::ranges::equal(once.children, again.children, [](const auto& a, const auto& b) {
        return a.low == b.low && a.high == b.high && a.entry == b.entry;
    }));
}

TEST_CASE("bvh: slots lie where their number says") {
    // Eight triangles in the corners of a cube: each slot holds the one of its octant.
    Mesh corners;
    for (uint32_t i = 0; i < 8; i++) {
        const vec3 at = vec3(i & 1, i >> 1 & 1, i >> 2 & 1) * 10.0f;
        for (const vec3 offset : {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)})
            corners.positions.push_back(at + offset);
        // Twice, so that a leaf cannot hold them all.
        corners.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        corners.triangles.push_back({3 * i, 3 * i + 2, 3 * i + 1});
    }
    const Bvh bvh = buildBvh(corners);
    for (uint32_t slot = 0; slot < shared::kBvhWidth; slot++) {
        const shared::BvhChild& child = bvh.children[slot];
        if (!(child.low.x <= child.high.x)) continue;
        const vec3 middle = 0.5f * (child.low + child.high) - 5.5f;
        const vec3 octant = vec3(slot & 1, slot >> 1 & 1, slot >> 2 & 1) * 2.0f - 1.0f;
        CHECK_GT(glm::dot(middle, octant), 0);
    }
}

TEST_CASE("bvh: an empty mesh has a root without children") {
    const Bvh bvh = buildBvh({});
    REQUIRE_EQ(bvh.children.size(), shared::kBvhWidth);
    for (const shared::BvhChild& child : bvh.children) CHECK_GT(child.low.x, child.high.x);
    CHECK(bvh.triangles.empty());
}
