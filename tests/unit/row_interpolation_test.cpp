// Tests which vertices a preview bakes, and how it interpolates their rows.
#include "engine/import/builtin_mesh.h"
#include "precompute/bake/coarse_neighbors.h"
#include "precompute/bake/coarse_rows.h"
#include "precompute/bake/coarse_vertices.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <random>
#include <set>

using namespace relume;

namespace {

// Two parallel squares of 21 x 21 vertices a hair apart, back to back.
Mesh makeThinSheet() {
    Mesh sheet;
    for (const float side : {1.0f, -1.0f})
        for (int y = 0; y < 21; y++)
            for (int x = 0; x < 21; x++) {
                sheet.positions.push_back({float(x) * 0.05f, side * 1e-3f, float(y) * 0.05f});
                sheet.normals.push_back({0, side, 0});
                const auto at = uint32_t(sheet.positions.size()) - 1;
                if (x == 0 || y == 0) continue;
                const uvec3 one(at, at - 1, at - 22), other(at, at - 22, at - 21);
                for (const uvec3& t : {one, other})
                    sheet.triangles.push_back(side > 0 ? t : uvec3(t.x, t.z, t.y));
            }
    return sheet;
}

struct Coarse {
    float spacing;
    std::vector<uint32_t> vertices;
};

Coarse chooseOf(const Mesh& mesh, size_t count) {
    const float spacing = vertexSpacing(mesh, count);
    return {spacing, coarseVertices(mesh, count, spacing)};
}

// Two terms of `rowOf(vertex, term)`: index to value.
template <typename RowOf>
BakedRows makeRows(uint32_t vertices, const RowOf& rowOf) {
    BakedRows rows(2);
    for (uint32_t vertex = 0; vertex < vertices; vertex++)
        for (uint32_t term = 0; term < 2; term++) {
            for (const auto& [index, value] : rowOf(vertex, term)) {
                rows.transport.indices.push_back(uint16_t(index));
                rows.transport.values.push_back(packCoefficient(value));
            }
            rows.transport.rowStarts.push_back(rows.transport.entries());
            rows.transport.scales.push_back(0.5f);
            rows.losses.push_back({1, 0.25, 0.125});
        }
    rows.transport.vertices = vertices;
    return rows;
}

} // namespace

TEST_CASE("coarse vertices: as many as asked, spread over the whole, the same each time") {
    const Mesh mesh = makeKnot(6000);
    const Coarse coarse = chooseOf(mesh, 500);
    CHECK_GE(coarse.vertices.size(), 500);
    CHECK_LE(coarse.vertices.size(), 510);
    CHECK(std::ranges::is_sorted(coarse.vertices));
    CHECK_EQ(std::set(coarse.vertices.begin(), coarse.vertices.end()).size(), coarse.vertices.size());
    CHECK(chooseOf(mesh, 500).vertices == coarse.vertices);
    float farthest = 0;
    for (size_t vertex = 0; vertex < mesh.vertexCount(); vertex++) {
        float nearest = 1e9f;
        for (const uint32_t other : coarse.vertices)
            if (glm::dot(mesh.normals[vertex], mesh.normals[other]) > 0.5f)
                nearest = std::min(nearest, glm::distance(mesh.positions[vertex], mesh.positions[other]));
        farthest = std::max(farthest, nearest);
    }
    CHECK_LT(farthest, 3 * coarse.spacing);
    CHECK_EQ(chooseOf(mesh, mesh.vertexCount()).vertices.size(), mesh.vertexCount());
}

TEST_CASE("coarse vertices: one for every way that a surface faces, however few") {
    const Mesh mesh = makeSphere(3);
    const std::vector<uint32_t> coarse = chooseOf(mesh, 1).vertices;
    CHECK_GT(coarse.size(), 1);
    CHECK_LT(coarse.size(), 30);
    for (const vec3 normal : mesh.normals)
        CHECK(std::ranges::any_of(coarse, [&](uint32_t other) {
            return glm::dot(normal, mesh.normals[other]) > kLeastNormalCosine;
        }));
}

TEST_CASE("coarse neighbors: shares add up, a coarse vertex has itself, none is across a thin sheet") {
    for (const Mesh& mesh : {makeThinSheet(), makeKnot(6000)}) {
        const Coarse coarse = chooseOf(mesh, mesh.vertexCount() / 12);
        const CoarseNeighbors neighbors(mesh, coarse.vertices, coarse.spacing);
        for (uint32_t vertex = 0; vertex < mesh.vertexCount(); vertex++) {
            const std::vector<CoarseNeighbor> of = neighbors.of(vertex);
            float sum = 0;
            for (const CoarseNeighbor& neighbor : of) {
                CHECK_GT(neighbor.weight, 0);
                const uint32_t other = coarse.vertices[neighbor.coarse];
                CHECK_GT(glm::dot(mesh.normals[vertex], mesh.normals[other]), kLeastNormalCosine);
                sum += neighbor.weight;
            }
            CHECK_EQ(sum, doctest::Approx(1));
        }
        for (uint32_t i = 0; i < coarse.vertices.size(); i++) {
            REQUIRE_EQ(neighbors.of(coarse.vertices[i]).size(), 1);
            CHECK_EQ(neighbors.of(coarse.vertices[i]).front().coarse, i);
        }
    }
}

TEST_CASE("coarse neighbors: a smooth function of place comes out smooth") {
    const Mesh mesh = makeThinSheet();
    const Coarse coarse = chooseOf(mesh, mesh.vertexCount() / 12);
    const CoarseNeighbors neighbors(mesh, coarse.vertices, coarse.spacing);
    const auto value = [&](uint32_t vertex) { return mesh.positions[vertex].x; };
    double weighted = 0, nearest = 0;
    for (uint32_t vertex = 0; vertex < mesh.vertexCount(); vertex++) {
        float sum = 0;
        CoarseNeighbor first{0, 0};
        for (const CoarseNeighbor& neighbor : neighbors.of(vertex)) {
            sum += neighbor.weight * value(coarse.vertices[neighbor.coarse]);
            if (neighbor.weight > first.weight) first = neighbor;
        }
        weighted += std::pow(double(sum - value(vertex)), 2);
        nearest += std::pow(double(value(coarse.vertices[first.coarse]) - value(vertex)), 2);
    }
    CHECK_LT(weighted, 0.15 * nearest);
}

TEST_CASE("row interpolation: a single neighbor's rows as they are, a constant stays constant") {
    const auto same = [](uint32_t, uint32_t term) {
        return std::vector<std::pair<int, ivec3>>{{3 + int(term), {1023, -700, 511}}, {4000, {-5, 12, 1}}};
    };
    const BakedRows coarse = makeRows(5, same), expected = makeRows(1, same);
    RowInterpolator interpolator(coarse, 6144, 8);
    for (const std::vector<CoarseNeighbor>& of :
         {std::vector<CoarseNeighbor>{{3, 1}},
          std::vector<CoarseNeighbor>{{0, 0.5f}, {2, 0.25f}, {4, 0.25f}}}) {
        BakedRows rows(2);
        interpolator.append(of, rows);
        CHECK_EQ(rows.transport.vertices, 1);
        CHECK(rows.transport.rowStarts == expected.transport.rowStarts);
        CHECK(rows.transport.indices == expected.transport.indices);
        CHECK(rows.transport.values == expected.transport.values);
        CHECK(rows.transport.scales == expected.transport.scales);
        REQUIRE_EQ(rows.losses.size(), 2);
        CHECK_EQ(rows.losses[1].total, 1);
        CHECK_EQ(rows.losses[1].dropped, 0.25);
    }
}

TEST_CASE("row interpolation: rows of different coefficients are added, and the largest kept") {
    const BakedRows coarse = makeRows(2, [](uint32_t vertex, uint32_t) {
        return vertex == 0 ? std::vector<std::pair<int, ivec3>>{{7, {1023, 1023, 511}}, {9, {20, 20, 10}}}
                           : std::vector<std::pair<int, ivec3>>{{2, {500, 500, 250}}, {9, {40, 40, 20}}};
    });
    RowInterpolator interpolator(coarse, 6144, 2);
    BakedRows rows(2);
    interpolator.append(std::vector<CoarseNeighbor>{{0, 0.5f}, {1, 0.5f}}, rows);
    CHECK(rows.transport.indices == std::vector<uint16_t>{2, 7, 2, 7});
    CHECK(rows.transport.scales == std::vector<float>{0.25f, 0.25f});
    CHECK(unpackCoefficient(rows.transport.values[0]) == ivec3(500, 500, 250));
    CHECK(unpackCoefficient(rows.transport.values[1]) == ivec3(1023, 1023, 511));
}
