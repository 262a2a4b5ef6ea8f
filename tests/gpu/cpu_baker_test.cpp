// The CPU baker's rows against the device's.
#include "apps/bench/cpu_baker.h"
#include "engine/import/builtin_mesh.h"
#include "engine/import/scene.h"
#include "precompute/bake/bake.h"
#include "precompute/twins/vertex_check.h"
#include "tests/support/test_device.h"

#include <cmath>

using namespace relume;

TEST_CASE("cpu baker: its rows are the device's, up to silhouettes and exchanges at the N-th place") {
    const TestDevice device;
    Scene scene;
    scene.parts.push_back({"knot", makeKnot(300), "ashikhmin-shirley", "built-in knot", ""});
    addGround(scene, {.tessellation = 5}, "white-diffuse");
    BakeOptions options;
    options.layout = {.layout = TransportLayout::Rows};
    options.factorization.terms = 3;
    options.visibilitySize = 128;
    const Asset asset = bake(device, std::move(scene), options);

    double difference = 0, size = 0;
    TransportLosses losses;
    std::vector<vec3> dense(6 * size_t(asset.faceSize) * size_t(asset.faceSize), vec3(0));
    for (const AssetPart& part : asset.parts) {
        REQUIRE_EQ(part.sets.size(), 1u);
        const SparseTransport& expected = rowsOf(part.sets[0].transport);
        std::vector<shared::BakePoint> points;
        for (size_t vertex = 0; vertex < part.mesh.vertexCount(); vertex++)
            points.push_back(bakePoint(part.mesh, vertex, asset.visibilityOffset));
        SparseTransport found{expected.vertices, expected.terms, {0}, {}, {}, {}};
        CpuBaker(asset, part, options).bake(points, std::array{&found}, losses);
        REQUIRE_EQ(found.scales.size(), expected.rows());
        for (size_t row = 0; row < expected.rows(); row++) {
            const auto add = [&](const SparseTransport& rows, float sign) {
                const PackedRow packed = storedRow(rows, row / rows.terms, row % rows.terms);
                for (size_t i = 0; i < packed.indices.size(); i++) {
                    const vec3 value = vec3(unpackCoefficient(packed.values[i])) *
                                       (packed.scale / vec3(kRedMaximum, kGreenMaximum, kBlueMaximum));
                    dense[packed.indices[i]] += sign * value;
                    if (sign > 0) size += double(glm::dot(value, value));
                }
            };
            add(expected, 1);
            add(found, -1);
            for (vec3& value : dense) {
                difference += double(glm::dot(value, value));
                value = vec3(0);
            }
        }
    }
    CHECK_GT(size, 0);
    CHECK_LE(std::sqrt(difference), 0.02 * std::sqrt(size));
    CHECK(std::sqrt(losses.dropped / losses.total) ==
          doctest::Approx(double(asset.truncationError)).epsilon(0.01));
    CHECK(std::sqrt(losses.quantized / (losses.total - losses.dropped)) ==
          doctest::Approx(double(asset.quantizationError)).epsilon(0.01));
}
