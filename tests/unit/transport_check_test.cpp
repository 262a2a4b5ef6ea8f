#include "engine/base/error.h"
#include "engine/transport/asset_check.h"
#include "tests/support/asset_sample.h"

#include <doctest/doctest.h>
#include <limits>

using namespace relume;
using namespace relume::test;

TEST_CASE("transport check: bases that make no sense are refused") {
    const auto refuses = [](const auto& spoil) {
        Asset asset = mixedAsset();
        spoil(std::get<BasisTransport>(asset.parts[2].sets[0].transport));
        CHECK_THROWS_AS(checkAsset(asset, "test"), Error);
    };
    checkAsset(mixedAsset(), "test");
    refuses([](BasisTransport& t) { t.vertices++; });
    refuses([](BasisTransport& t) { t.terms--; });
    refuses([](BasisTransport& t) { t.kinds[2].term = 0; });
    refuses([](BasisTransport& t) { t.kinds[1].term = 2; });
    refuses([](BasisTransport& t) { t.kinds[0].color.y = std::numeric_limits<float>::infinity(); });
    refuses([](BasisTransport& t) { t.kinds.pop_back(); });
    refuses([](BasisTransport& t) { t.clusters.pop_back(); });
    refuses([](BasisTransport& t) { t.clusters[0].components++; });
    refuses([](BasisTransport& t) { t.clusters[0].indices[1] = t.clusters[0].indices[0]; });
    refuses([](BasisTransport& t) { t.clusters[0].indices.back() = 384; });
    refuses([](BasisTransport& t) { t.clusters[0].basis.pop_back(); });
    refuses([](BasisTransport& t) { t.clusters[0].basis[3] = -128; });
    refuses([](BasisTransport& t) { t.clusters[0].counts[0]++; });
    refuses([](BasisTransport& t) { t.clusters[0].counts[0] = 1000; });
    refuses([](BasisTransport& t) { t.clusters[0].scales[0] = -1; });
    refuses([](BasisTransport& t) { t.clusters[0].weights[5] = -128; });
    refuses([](BasisTransport& t) { t.clusters[0].weights.pop_back(); });
}
