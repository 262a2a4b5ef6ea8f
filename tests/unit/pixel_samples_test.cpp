// Tests the positions of a pixel's samples, and which of them are shaded as one.
#include "engine/render/pixel_samples.h"

#include "engine/base/error.h"

#include <doctest/doctest.h>

using namespace relume;

namespace {

using Seen = std::vector<uint32_t>;

// Triangles of the same ten share a vertex, as they would on a smooth surface.
std::vector<uint32_t> groups(const Seen& seen) {
    return groupSamples(seen, [](uint32_t a, uint32_t b) { return a / 10 == b / 10; });
}

} // namespace

TEST_CASE("pixel samples: lie about the center, each in a row and a column of its own") {
    for (const int samples : {1, 2, 4, 8}) {
        vec2 mean(0);
        for (int i = 0; i < samples; i++) {
            const vec2 place = samplePosition(samples, i);
            mean += place / float(samples);
            for (int j = 0; j < i; j++) {
                const vec2 cells = glm::abs(glm::floor(place * float(samples)) -
                                            glm::floor(samplePosition(samples, j) * float(samples)));
                CHECK(cells.x >= 1);
                CHECK(cells.y >= 1);
            }
        }
        CHECK(mean == vec2(0.5f));
    }
    for (const int samples : {-1, 0, 3, 16}) CHECK_THROWS_AS(expectSamples(samples), UsageError);
}

TEST_CASE("pixel samples: those of a smooth surface are one") {
    using Groups = std::vector<uint32_t>;
    CHECK(groups({0, 0, 0, 0}).empty());
    CHECK(groups({11, 12, 12, 13}) == Groups{0b1111});
    CHECK(groups({0, 25, 11, 24}) == Groups{0b1010, 0b0100});
    CHECK(groups({11, 0, 25, 12}) == Groups{0b1001, 0b0100});
    CHECK(groups({10, 20, 30, 40}) == Groups{1, 2, 4, 8});
}
