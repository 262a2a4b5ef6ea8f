// The reference beside the frames: results come, and those of what is not wanted any more do not.
#include "apps/viewer/comparison.h"

#include "tests/support/test_device.h"
#include "tests/support/viewer_session.h"

#include <atomic>
#include <thread>

using namespace relume;
using namespace relume::test;

namespace {

Comparison::View viewOf(const std::shared_ptr<const Model>& model, int width, int height, vec3 radiance) {
    const auto texels = size_t(6 * model->asset.faceSize * model->asset.faceSize);
    return {model,
            defaultCamera(model->bounds, 0.6f, float(width) / float(height)),
            {model->asset.faceSize, std::vector<vec3>(texels, radiance)},
            defaultAppearance(model->asset),
            Image(width, height)};
}

// Waits for one with so many passes, for a minute at most.
Comparison::Result awaitResult(Comparison& comparison, int passes) {
    for (int i = 0; i < 6000; i++) {
        if (auto result = comparison.take(); result && result->passes >= passes) return *result;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    FAIL("no result comes");
    return {};
}

vec4 sumOf(const Image& image) {
    vec4 sum(0);
    for (const vec4& pixel : image.pixels) sum += pixel;
    return sum;
}

} // namespace

TEST_CASE("comparison: results arrive, get better, and are dropped when nobody wants them") {
    const TestDevice device;
    const auto model = std::make_shared<const Model>(device, sharedSession().path("ring.relume"));
    std::atomic<int> woken = 0;
    Comparison comparison([&] { woken++; });
    CHECK_FALSE(comparison.take());

    comparison.begin(viewOf(model, 64, 48, vec3(1)));
    const Comparison::Result first = awaitResult(comparison, 1);
    CHECK_GT(woken, 0);
    CHECK_EQ(first.failure, "");
    CHECK_EQ(first.reference.width, 64);
    CHECK_GT(sumOf(first.reference).w, 300); // covered
    CHECK_GT(sumOf(first.reference).x, 0);
    const Comparison::Result later = awaitResult(comparison, first.passes + 2);
    REQUIRE(later.error);
    CHECK(later.error->rmse == doctest::Approx(later.error->level).epsilon(0.05)); // against black

    // Another view takes the place of this one.
    comparison.begin(viewOf(model, 32, 24, vec3(0)));
    const Comparison::Result dark = awaitResult(comparison, 1);
    CHECK_EQ(dark.reference.width, 32);
    CHECK_EQ(sumOf(dark.reference).x, 0);

    comparison.begin(viewOf(model, 64, 48, vec3(1)));
    comparison.stop();
    CHECK_FALSE(comparison.take());
    std::this_thread::sleep_for(std::chrono::milliseconds(600)); // longer than results are apart
    CHECK_FALSE(comparison.take());

    comparison.begin(viewOf(model, 64, 48, vec3(2))); // and on again
    CHECK(sumOf(awaitResult(comparison, 1).reference).x > 1.5f * sumOf(first.reference).x);
} // which ends while rays are traced
