#include "precompute/transport/row_packing.h"

#include "precompute/twins/transport_twin.h"

#include <cmath>
#include <doctest/doctest.h>
#include <random>

using namespace relume;

namespace {

void checkAgainstTwin(const std::vector<vec3>& coefficients, int count) {
    const PackedRow row = packLargest(coefficients, count);
    const PackedRow twin = packRow(coefficients, selectLargest(coefficients, count));
    CHECK(row.scale == twin.scale);
    CHECK(row.indices == twin.indices);
    CHECK(row.values == twin.values);
    CHECK(row.indices.size() <= size_t(count));
}

} // namespace

TEST_CASE("row packing: the rows are the twin's") {
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    std::vector<vec3> coefficients(6 * 64 * 64, vec3(0));
    for (size_t i = 0; i < coefficients.size(); i += 1 + random() % 5)
        coefficients[i] =
            std::pow(10.f, 2 * normal(random)) * vec3(normal(random), normal(random), normal(random));
    for (const int count : {0, 1, 96, 384, 6 * 64 * 64}) checkAgainstTwin(coefficients, count);
}

TEST_CASE("row packing: of equal coefficients the first are kept") {
    const std::vector<vec3> equal(100, vec3(1, 0, 0));
    CHECK(packLargest(equal, 3).indices == std::vector<uint16_t>{0, 1, 2});
    checkAgainstTwin(equal, 3);
}

TEST_CASE("row packing: neither zeros nor what becomes zero are kept") {
    std::vector<vec3> coefficients(65536, vec3(0));
    coefficients[9] = vec3(0, 1e-6f, 0), coefficients[65535] = vec3(0, 0, -2);
    const PackedRow row = packLargest(coefficients, 5);
    CHECK(row.indices == std::vector<uint16_t>{65535});
    CHECK(row.scale == 2);
    CHECK(packLargest(std::vector<vec3>(10, vec3(0)), 5).indices.empty());
}
