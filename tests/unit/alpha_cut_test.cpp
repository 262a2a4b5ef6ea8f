// Tests removal of the holes that alpha makes in meshes.
#include "engine/import/alpha_cut.h"

#include "tests/support/log_capture.h"
#include "tests/support/mesh_samples.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <map>
#include <random>

using namespace relume;
using namespace relume::test;

namespace {

// White with an alpha that is given for the centers of texels, in [0, 1]².
template <typename Alpha>
Texture makeAlpha(int size, Alpha alphaAt) {
    Texture texture{size, size, {}, true};
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
            const float alpha = alphaAt((vec2(x, y) + 0.5f) / float(size));
            texture.texels.push_back(0xffffff | uint32_t(std::lround(255 * std::clamp(alpha, 0.f, 1.f)))
                                                    << 24);
        }
    return texture;
}

double areaOf(const Mesh& mesh) {
    double area = 0;
    for (const uvec3& t : mesh.triangles)
        area += 0.5 * double(glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                        mesh.positions[t.z] - mesh.positions[t.x])
                                 .z);
    return area;
}

// The middles of edges that one triangle has alone.
std::vector<vec3> rimOf(const Mesh& mesh) {
    std::map<std::pair<uint32_t, uint32_t>, int> uses;
    for (const uvec3& t : mesh.triangles)
        for (int corner = 0; corner < 3; corner++) uses[std::minmax(t[corner], t[(corner + 1) % 3])]++;
    std::vector<vec3> middles;
    for (const auto& [edge, count] : uses) {
        CHECK(count <= 2);
        if (count == 1) middles.push_back(0.5f * (mesh.positions[edge.first] + mesh.positions[edge.second]));
    }
    return middles;
}

bool isOnSquare(vec3 p) { return std::min({p.x, p.y, 1 - p.x, 1 - p.y}) < 1e-6f; }

} // namespace

TEST_CASE("alpha cut: a round hole is followed to half a texel, without cracks") {
    const auto alphaAt = [](vec2 p) { return 0.5f + 64 * (glm::distance(p, vec2(0.5f)) - 0.3f); };
    const Texture texture = makeAlpha(128, alphaAt);
    const Mesh mesh = cutByAlpha(makeSquare(), {.texture = &texture}, 0, "square");
    CHECK(areaOf(mesh) == doctest::Approx(1 - 3.14159265 * 0.09).epsilon(0.002));
    size_t round = 0;
    for (const vec3& middle : rimOf(mesh)) {
        if (isOnSquare(middle)) continue;
        round++;
        CHECK(std::abs(glm::distance(vec2(middle), vec2(0.5f)) - 0.3f) < 0.7f / 128);
    }
    CHECK(round > 12);
    CHECK(mesh.triangleCount() < 1000);
    REQUIRE(mesh.uvs.size() == mesh.vertexCount());
    for (size_t i = 0; i < mesh.vertexCount(); i++)
        CHECK(glm::distance(mesh.uvs[i], vec2(mesh.positions[i].x, 1 - mesh.positions[i].y)) < 1e-5f);
    // A tolerance of a twentieth of the square needs less.
    const Mesh coarse = cutByAlpha(makeSquare(), {.texture = &texture}, 0.05f, "square");
    CHECK(coarse.triangleCount() < mesh.triangleCount() / 2);
    CHECK(areaOf(coarse) == doctest::Approx(1 - 3.14159265 * 0.09).epsilon(0.05));
}

TEST_CASE("alpha cut: a straight edge needs few triangles, repetition none more than a copy of the image") {
    const Texture half = makeAlpha(256, [](vec2 p) { return std::abs(p.y - 0.5f) < 0.25f ? 1.0f : 0.0f; });
    const Mesh mesh = cutByAlpha(makeSquare(), {.texture = &half}, 0, "square");
    CHECK(mesh.triangleCount() < 40);
    CHECK(areaOf(mesh) == doctest::Approx(0.5).epsilon(0.005));
    const Texture round =
        makeAlpha(64, [](vec2 p) { return 0.5f + 32 * (glm::distance(p, vec2(0.5f)) - 0.3f); });
    Mesh tiled = makeSquare();
    for (vec2& uv : tiled.uvs) uv = 3.0f * uv - 7.0f;
    CHECK(areaOf(cutByAlpha(tiled, {.texture = &round}, 0, "square")) ==
          doctest::Approx(1 - 3.14159265 * 0.09).epsilon(0.01));
}

TEST_CASE("alpha cut: vertex colors and factor count, with and without a texture") {
    Mesh mesh = makeSquare();
    for (const vec3& p : mesh.positions) mesh.colors.push_back({1, 1, 1, 1 - p.x});
    CHECK(areaOf(cutByAlpha(mesh, {.cutoff = 0.25f}, 0, "square")) == doctest::Approx(0.75).epsilon(1e-4));
    CHECK(areaOf(cutByAlpha(mesh, {.factor = 0.5f, .cutoff = 0.25f}, 0, "square")) ==
          doctest::Approx(0.5).epsilon(1e-4));
    mesh.uvs.clear();
    CHECK(areaOf(cutByAlpha(mesh, {.cutoff = 0.25f}, 0, "square")) == doctest::Approx(0.75).epsilon(1e-4));
    mesh = makeSquare();
    for (const vec3& p : mesh.positions) mesh.colors.push_back({1, 1, 1, 1 - p.x});
    // 0.8 (1 - x) >= 0.4 above, 0.4 (1 - x) >= 0.4 nowhere below.
    const Texture two = makeAlpha(64, [](vec2 p) { return p.y < 0.5f ? 0.8f : 0.4f; });
    CHECK(areaOf(cutByAlpha(mesh, {.texture = &two, .cutoff = 0.4f}, 0, "square")) ==
          doctest::Approx(0.25).epsilon(0.03));
}

TEST_CASE("alpha cut: all, nothing, and alpha at the cutoff stays") {
    const Texture even = makeAlpha(8, [](vec2) { return 102.0f / 255; });
    CHECK(cutByAlpha(makeSquare(), {.texture = &even, .cutoff = 0.39f}, 0, "square").triangleCount() == 2);
    CHECK(cutByAlpha(makeSquare(), {.texture = &even, .cutoff = 0.41f}, 0, "square").triangles.empty());
    CHECK(cutByAlpha(makeSquare(), {.factor = 0.5f, .cutoff = 0.5f}, 0, "square").triangleCount() == 2);
    CHECK(cutByAlpha(makeSquare(), {.cutoff = 1.5f}, 0, "square").triangles.empty());
}

TEST_CASE("alpha cut: noise is given up at a bound, with a warning") {
    std::mt19937 random(5);
    const Texture noise = makeAlpha(1024, [&](vec2) { return float(random() % 2); });
    const LogCapture log;
    const Mesh mesh = cutByAlpha(makeSquare(), {.texture = &noise}, 0, "noise");
    CHECK(log.says("noise: its alpha has more detail"));
    CHECK(mesh.triangleCount() < 500'000);
}
