// Tests refinement: meshes get vertices where interpolation would be visible, and stay joined.
#include "engine/math/haar.h"
#include "precompute/refine/refinement.h"

#include "engine/base/error.h"
#include "engine/import/builtin_mesh.h"
#include "precompute/refine/edge_split.h"
#include "precompute/refine/transport_probe.h"
#include "precompute/thread_limit.h"
#include "precompute/transport/light_spectrum.h"
#include "precompute/twins/transport_twin.h"
#include "tests/support/diffuse_asset.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <map>
#include <random>
#include <set>

using namespace relume;
using namespace relume::test;

namespace {

std::vector<Edge> edgesOf(const Mesh& mesh) {
    std::set<Edge> edges;
    for (const uvec3& t : mesh.triangles) edges.insert({{t.x, t.y}, {t.y, t.z}, {t.z, t.x}});
    return {edges.begin(), edges.end()};
}

double surfaceArea(const Mesh& mesh) {
    double area = 0;
    for (const uvec3& t : mesh.triangles) {
        const vec3 a = mesh.positions[t.x];
        area += 0.5 * double(glm::length(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a)));
    }
    return area;
}

// Whether every edge has a twin that runs the other way, as on closed surfaces, once places are welded.
bool isWatertight(const Mesh& mesh) {
    std::map<std::array<float, 3>, uint32_t> places;
    const auto place = [&](uint32_t vertex) {
        const vec3 p = mesh.positions[vertex];
        return places.try_emplace({p.x, p.y, p.z}, uint32_t(places.size())).first->second;
    };
    std::map<std::pair<uint32_t, uint32_t>, int> sides;
    for (const uvec3& t : mesh.triangles)
        for (const auto& [a, b] : {std::pair(t.x, t.y), std::pair(t.y, t.z), std::pair(t.z, t.x)})
            sides[{place(a), place(b)}]++;
    return std::ranges::all_of(sides, [&](const auto& side) {
        const auto twin = sides.find({side.first.second, side.first.first});
        return side.second == 1 && twin != sides.end() && twin->second == 1;
    });
}

// A roof over the middle of a plane: a part of each, and both as the occluder.
struct RoofedPlane {
    explicit RoofedPlane(int quads = 8) {
        Mesh roof = makePlane(1, 1);
        for (vec3& position : roof.positions) position.y = 0.3f;
        parts.push_back(makeDiffusePart(makePlane(4, quads), 0.8f));
        parts.push_back(makeDiffusePart(roof, 0.8f));
        for (const AssetPart& part : parts) append(occluder, part.mesh);
    }

    RefinementRecord refineTo(double wanted, float offset = 1e-3f) {
        BakeObserver silent;
        return refine(parts, occluder, offset, {.wanted = wanted}, silent);
    }

    std::vector<AssetPart> parts;
    Mesh occluder;
};

// Root mean square error of interpolated responses over points of the plane, which lie anywhere.
double interpolationError(const RoofedPlane& scene) {
    const CpuVisibility visibility(scene.occluder, TransportProbe::kVisibilitySize);
    const ProbeLights lights;
    const TransportProbe probe(scene.parts[0], visibility, lights);
    TransportProbe::Workspace workspace = probe.makeWorkspace();
    const auto responsesAt = [&](vec3 position) {
        return probe.probe(position + vec3(0, 1e-3f, 0), tangentFrame({0, 1, 0}), workspace).seen;
    };
    const Mesh& plane = scene.parts[0].mesh;
    std::vector<ProbeResponses> responses;
    for (const vec3& position : plane.positions) responses.push_back(responsesAt(position));
    const RayTracer tracer(std::array<const Mesh*, 1>{&plane});
    std::mt19937 random(5);
    std::uniform_real_distribution<float> place(-1.99f, 1.99f);
    double sum = 0;
    for (int i = 0; i < 600; i++) {
        const vec3 position(place(random), 0, place(random));
        const auto hit = tracer.intersect(position + vec3(0, 1, 0), vec3(0, -1, 0));
        REQUIRE(hit);
        const uvec3 t = plane.triangles[hit->triangle];
        const ProbeResponses there = responsesAt(position);
        for (size_t j = 0; j < there.size(); j++) {
            const float mean = hit->weights.x * responses[t.x][j] + hit->weights.y * responses[t.y][j] +
                               hit->weights.z * responses[t.z][j];
            sum += double(mean - there[j]) * double(mean - there[j]);
        }
    }
    return std::sqrt(sum);
}

} // namespace

TEST_CASE("edge split: a closed surface stays closed, as large and as smooth, whichever edges are split") {
    std::mt19937 random(3);
    for (const unsigned oneIn : {1u, 2u, 3u, 10u}) {
        CAPTURE(oneIn);
        Mesh mesh = makeSphere(2, true);
        mesh.colors.assign(mesh.vertexCount(), vec4(0.25f));
        for (const vec3& normal : mesh.normals) mesh.tangents.push_back(tangentFrame(normal, {1, 2, 3}).s);
        const Mesh before = mesh;
        std::vector<Edge> edges;
        std::map<std::array<float, 3>, bool> isChosen; // by the middle: along seams both or none
        for (const Edge& edge : edgesOf(mesh)) {
            const vec3 middle = middleOf(mesh, edge).position;
            const bool chosen = random() % oneIn == 0;
            if (isChosen.try_emplace({middle.x, middle.y, middle.z}, chosen).first->second)
                edges.push_back(edge);
        }
        std::ranges::shuffle(edges, random);
        splitEdges(mesh, edges);
        REQUIRE_EQ(mesh.vertexCount(), before.vertexCount() + edges.size());
        CHECK(isWatertight(mesh));
        CHECK(surfaceArea(mesh) == doctest::Approx(surfaceArea(before)).epsilon(1e-6));
        for (size_t i = 0; i < edges.size(); i++) {
            const size_t added = before.vertexCount() + i;
            const auto [a, b] = edges[i];
            CHECK(mesh.positions[added] == 0.5f * (before.positions[a] + before.positions[b]));
            CHECK(mesh.uvs[added] == 0.5f * (before.uvs[a] + before.uvs[b]));
            CHECK(mesh.colors[added] == vec4(0.25f));
            CHECK(glm::length(mesh.tangents[added]) == doctest::Approx(1));
            CHECK(std::abs(glm::dot(mesh.tangents[added], mesh.normals[added])) < 1e-5f);
            CHECK(glm::dot(mesh.tangents[added], before.tangents[a] + before.tangents[b]) > 0.5f);
            CHECK(glm::length(mesh.normals[added]) == doctest::Approx(1));
            CHECK(glm::dot(mesh.normals[added], mesh.positions[added]) > 0.9f);
        }
    }
}

TEST_CASE("edge split: two, three or four triangles, that face as before") {
    const Mesh triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, std::vector<vec3>(3, {0, 0, 1}), {{0, 1, 2}}};
    const std::vector<Edge> all = {{0, 1}, {1, 2}, {2, 0}};
    for (unsigned chosen = 0; chosen < 8; chosen++) {
        CAPTURE(chosen);
        std::vector<Edge> edges;
        for (unsigned i = 0; i < 3; i++)
            if (chosen >> i & 1) edges.push_back(all[i]);
        Mesh mesh = triangle;
        splitEdges(mesh, edges);
        CHECK_EQ(mesh.triangleCount(), edges.size() + 1);
        CHECK(surfaceArea(mesh) == doctest::Approx(0.5));
        for (const uvec3& t : mesh.triangles) {
            const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
            CHECK(glm::cross(b - a, c - a).z > 0.1f);
        }
    }
}

TEST_CASE("edge split: normals that point apart leave a unit normal") {
    Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 0, -1}, {0, 0, 1}}, {{0, 1, 2}}};
    splitEdges(mesh, std::vector<Edge>{{0, 1}});
    CHECK(mesh.normals[3] == vec3(0, 0, 1));
}

TEST_CASE("transport probe: responses differ as transport does that light weighs") {
    const RoofedPlane scene;
    constexpr int kSize = TransportProbe::kVisibilitySize, kFace = ProbeLights::kFaceSize;
    const CpuVisibility visibility(scene.occluder, kSize);
    const ProbeLights lights;
    const TransportProbe probe(scene.parts[0], visibility, lights);
    TransportProbe::Workspace workspace = probe.makeWorkspace();
    const RayTracer tracer(std::array<const Mesh*, 1>{&scene.occluder});
    const std::vector<float> spectrum = lightSpectrum(kFace);
    const FactoredBrdf& brdf = scene.parts[0].sets[0].brdf;
    const vec3 up(0, 1, 0);
    const auto coefficients = [&](vec3 origin) {
        std::vector<vec3> cube = transportVector(visibilityCube(tracer, origin, up, kSize), kSize, kFace, 1,
                                                 brdf, 0, tangentFrame(up));
        haarForwardFaces(cube, kFace);
        return cube;
    };
    double answered = 0, expected = 0;
    for (const float x : {0.1f, 0.4f, 0.6f, 1.2f})
        for (const float step : {0.05f, 0.3f}) {
            const vec3 first(x, 1e-3f, 0.1f), other(x + step, 1e-3f, 0.2f);
            const ProbeResponses a = probe.probe(first, tangentFrame(up), workspace).seen,
                                 b = probe.probe(other, tangentFrame(up), workspace).seen;
            double between = 0, weighted = 0;
            for (size_t i = 0; i < a.size(); i++) between += double(a[i] - b[i]) * double(a[i] - b[i]);
            const std::vector<vec3> one = coefficients(first), two = coefficients(other);
            for (size_t i = 0; i < one.size(); i++) {
                const vec3 difference = spectrum[i] * (one[i] - two[i]) * brdf.viewMaps[0];
                weighted += double(glm::dot(difference, difference));
            }
            between /= kProbeLights;
            CHECK(between > 0.4 * weighted);
            CHECK(between < 2.2 * weighted);
            answered += between, expected += weighted;
        }
    CHECK(answered == doctest::Approx(expected).epsilon(0.25));
}

TEST_CASE("transport probe: a white surface in the open has the energy that is said") {
    const Mesh plane = makePlane(1, 1);
    const AssetPart part = makeDiffusePart(plane, 1);
    const CpuVisibility visibility(plane, TransportProbe::kVisibilitySize);
    const ProbeLights lights;
    const TransportProbe probe(part, visibility, lights);
    TransportProbe::Workspace workspace = probe.makeWorkspace();
    double energy = 0;
    for (const float response : probe.probe({0, 1, 0}, tangentFrame({0, 1, 0}), workspace).seen)
        energy += double(response) * double(response);
    CHECK(energy == doctest::Approx(lights.whiteEnergy()).epsilon(0.3));
}

TEST_CASE("transport probe: what is blocked is what the unshadowed transport has more") {
    RoofedPlane scene;
    scene.parts[0].sets[0].residual = std::make_shared<ResidualSet>();
    const CpuVisibility visibility(scene.occluder, TransportProbe::kVisibilitySize);
    const ProbeLights lights;
    const TransportProbe probe(scene.parts[0], visibility, lights);
    TransportProbe::Workspace workspace = probe.makeWorkspace();
    const TangentFrame frame = tangentFrame({0, 1, 0});
    const ProbedPoint under = probe.probe({0.1f, 1e-3f, 0.1f}, frame, workspace),
                      above = probe.probe({0, 1, 0}, frame, workspace);
    CHECK(above.blocked == ProbeResponses{});
    CHECK(under.blocked != ProbeResponses{});
    for (size_t i = 0; i < under.seen.size(); i++)
        CHECK(under.seen[i] + under.blocked[i] == doctest::Approx(above.seen[i]).epsilon(1e-3));
}

// A sphere in the open sees everything, one in a closed shell nothing.
TEST_CASE("refinement: a curved surface with a residual is refined where its shadow changes alone") {
    for (const bool isHidden : {false, true}) {
        CAPTURE(isHidden);
        std::vector<AssetPart> parts = {makeDiffusePart(makeSphere(1), 0.8f)};
        Mesh occluder = makeSphere(3);
        for (vec3& position : occluder.positions) position *= isHidden ? 2.0f : 0.1f;
        BakeObserver silent;
        parts[0].sets[0].residual = std::make_shared<ResidualSet>();
        const RefinementRecord record = refine(parts, occluder, 1e-3f, {kLeastRefinementError}, silent);
        CHECK(record.vertices == record.startVertices);
        if (isHidden) continue;
        parts[0].sets[0].residual = nullptr;
        CHECK(refine(parts, occluder, 1e-3f, {0.05}, silent).startError > 100 * record.error);
    }
}

TEST_CASE("refinement: a plane that nothing shadows stays as it is") {
    std::vector<AssetPart> parts = {makeDiffusePart(makePlane(4, 8), 0.8f)};
    const Mesh occluder = parts[0].mesh, before = occluder;
    BakeObserver silent;
    const RefinementRecord record = refine(parts, occluder, 1e-3f, {kLeastRefinementError}, silent);
    CHECK(parts[0].mesh.positions == before.positions);
    CHECK(parts[0].mesh.triangles == before.triangles);
    CHECK_EQ(record, RefinementRecord{kLeastRefinementError, 0, 0, 81, 81});
}

TEST_CASE("refinement: vertices go where shadows end, until the error is what was asked for") {
    RoofedPlane coarse, fine;
    const Mesh before = coarse.parts[0].mesh;
    const RefinementRecord some = coarse.refineTo(0.05), more = fine.refineTo(0.03);
    CHECK(some.startError > 0.1);
    CHECK(some.startError == more.startError);
    CHECK(some.error <= 0.05);
    CHECK(more.error <= 0.03);
    CHECK(more.vertices > some.vertices);
    CHECK_EQ(some.startVertices, 85);
    CHECK_EQ(some.vertices, coarse.parts[0].mesh.vertexCount() + coarse.parts[1].mesh.vertexCount());
    const Mesh& mesh = coarse.parts[0].mesh;
    CHECK(std::equal(before.positions.begin(), before.positions.end(), mesh.positions.begin()));
    CHECK(surfaceArea(mesh) == doctest::Approx(16).epsilon(1e-6));
    // The roof's shadow, and as much around it, is a quarter of the plane.
    const auto inside = std::ranges::count_if(std::span(mesh.positions).subspan(81), [](vec3 p) {
        return std::max(std::abs(p.x), std::abs(p.z)) < 1.001f;
    });
    CHECK(inside > 0.8 * double(mesh.vertexCount() - 81));
    // No vertex lies in the middle of an edge.
    std::set<std::array<float, 3>> places;
    for (const vec3& p : mesh.positions) CHECK(places.insert({p.x, p.y, p.z}).second);
    for (const Edge& edge : edgesOf(mesh)) {
        const vec3 middle = middleOf(mesh, edge).position;
        CHECK_FALSE(places.contains({middle.x, middle.y, middle.z}));
    }
}

TEST_CASE("refinement: a third of a uniform plane's vertices are more exact, anywhere on it") {
    const RoofedPlane uniform(30);
    RoofedPlane refined(8);
    refined.refineTo(0.022);
    CAPTURE(refined.parts[0].mesh.vertexCount());
    CHECK(3 * refined.parts[0].mesh.vertexCount() < uniform.parts[0].mesh.vertexCount());
    CHECK(interpolationError(refined) < 0.9 * interpolationError(uniform));
}

TEST_CASE("refinement: the same on one thread as on all") {
    RoofedPlane first, other;
    {
        const ThreadLimit limit(1);
        first.refineTo(0.05);
    }
    other.refineTo(0.05);
    for (size_t part = 0; part < 2; part++) {
        CHECK(first.parts[part].mesh.positions == other.parts[part].mesh.positions);
        CHECK(first.parts[part].mesh.triangles == other.parts[part].mesh.triangles);
    }
}

TEST_CASE("refinement: parts that touch stay joined, whatever they are made of") {
    // A plane in two halves, the roof above one of them.
    RoofedPlane scene;
    const Mesh left = makeQuad({-2, 0, -2}, {0, 0, 4}, {2, 0, 0}),
               right = makeQuad({0, 0, -2}, {0, 0, 4}, {2, 0, 0});
    scene.parts = {makeDiffusePart(left, 0.8f), makeDiffusePart(right, 0.01f)};
    for (vec3& position : scene.occluder.positions) position.x += position.y > 0 ? 0.3f : 0;
    scene.refineTo(0.03);
    std::array<std::set<float>, 2> borders;
    for (size_t part = 0; part < 2; part++)
        for (const vec3& p : scene.parts[part].mesh.positions)
            if (p.x == 0) borders[part].insert(p.z);
    CHECK(borders[0].size() > 6);
    CHECK(borders[0] == borders[1]);
}

TEST_CASE("refinement: parts that are left out stay as they are, and nothing tears beside them") {
    // A plane in two halves, the roof above their border.
    RoofedPlane scene;
    const Mesh left = makeQuad({-2, 0, -2}, {0, 0, 4}, {2, 0, 0}),
               right = makeQuad({0, 0, -2}, {0, 0, 4}, {2, 0, 0});
    scene.parts = {makeDiffusePart(left, 0.8f), makeDiffusePart(right, 0.8f)};
    BakeObserver silent;
    const RefinementRecord record =
        refine(scene.parts, scene.occluder, 1e-3f,
               {.wanted = 0.01, .mostVertices = 60, .isRefined = {true, false}}, silent);
    const Mesh& refined = scene.parts[0].mesh;
    CHECK(scene.parts[1].mesh.positions == right.positions);
    CHECK(scene.parts[1].mesh.triangles == right.triangles);
    CHECK_EQ(std::ranges::count(refined.positions, 0.0f, &vec3::x), 2);
    CHECK(refined.vertexCount() > 50);
    CHECK(refined.vertexCount() <= 60);
    CHECK_EQ(record.startVertices, left.vertexCount() + right.vertexCount());
    CHECK_EQ(record.vertices, refined.vertexCount() + right.vertexCount());
    CHECK(record.error > 0.01);
}

TEST_CASE("refinement: it ends where edges are too short to split") {
    RoofedPlane scene(2);
    const RefinementRecord record = scene.refineTo(kLeastRefinementError, 0.05f);
    CHECK(record.error > kLeastRefinementError);
    CHECK(record.vertices < 2000);
    CHECK(record.vertices > record.startVertices);
}

TEST_CASE("refinement: meshes with nothing to interpolate") {
    const vec3 up(0, 1, 0);
    const std::vector<vec3> ups(3, up);
    std::vector<AssetPart> parts = {
        makeDiffusePart({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, ups, {{0, 1, 2}}}, 1),            // no area
        makeDiffusePart({{{0, 0, 0}, {0, 0, 0}, {0, 0, 1}}, ups, {{0, 1, 2}, {0, 0, 2}}}, 1), // no length
        makeDiffusePart({{{0, 0, 0}}, {up}, {}}, 1),                                          // no triangle
        makeDiffusePart(makePlane(1, 2), 0)};                                                 // black
    const Mesh occluder = makePlane(1, 2);
    BakeObserver silent;
    const RefinementRecord record = refine(parts, occluder, 1e-4f, {0.01}, silent);
    CHECK_EQ(record.vertices, 16);
    CHECK_EQ(record.error, 0);
}

TEST_CASE("refinement: more vertices than there may be, and a request to stop") {
    struct Stop : BakeObserver {
        bool wantsStop() override { return true; }
    } stop;
    RoofedPlane scene;
    CHECK_THROWS_AS(refine(scene.parts, scene.occluder, 1e-3f, {0.05}, stop), BakeStopped);
    Mesh& mesh = scene.parts[1].mesh;
    mesh.positions.resize(kMostRefinedVertices);
    mesh.normals.resize(kMostRefinedVertices, vec3(0, 1, 0));
    CHECK_THROWS_AS(scene.refineTo(0.05), Error);
}
