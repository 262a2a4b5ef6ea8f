// Ray tracing beside the relit view, as the window shows it.
#include "engine/render/tone_map.h"
#include "tests/support/viewer_session.h"
#include "tests/support/window_image.h"

using namespace relume;
using namespace relume::test;
using nlohmann::json;

namespace {

constexpr int kWidth = 320;

json settled() { return {{"wait", "settled"}}; }
json passes(int count) { return {{"wait", {{"passes", count}}}}; }
json shot(const std::string& file) { return {{"screenshot", file}}; }
json set(const char* name, const json& value) { return {{"set", {{name, value}}}}; }

} // namespace

TEST_CASE("viewer: a ground is a shadow on the background in the reference, too") {
    ViewerSession& session = sharedSession();
    const Outcome outcome = session.replay({{{"resize", {320, 240}}},
                                            {{"frames", 3}},
                                            {{"set", {{"panels", false}, {"tone", "none"}, {"exposure", 0}}}},
                                            settled(),
                                            shot("shadow.png"),
                                            set("compare", "reference"),
                                            passes(16),
                                            shot("shadow-reference.png"),
                                            set("compare", "difference"),
                                            passes(2),
                                            shot("shadow-difference.png"),
                                            {{"set", {{"compare", "off"}, {"ground-style", "whole"}}}},
                                            {{"frames", 2}},
                                            shot("whole.png"),
                                            {{"quit", true}}},
                                           "ring.relume room.exr");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    const auto image = [&](const char* file) { return windowImage(session.path(file)); };
    const Image shadow = image("shadow.png"), reference = image("shadow-reference.png"),
                whole = image("whole.png");
    CHECK_LT(meanDifference(reference, shadow), 0.2 * meanDifference(whole, shadow));
    CHECK_GT(differingPixels(image("shadow-difference.png"), shadow), 1000);
}

TEST_CASE("viewer: the reference is beside the view, alone and as a difference, and follows the view") {
    ViewerSession& session = sharedSession();
    // Panels and background are not in the way, and tone curves bend nothing.
    const Outcome outcome = session.replay(
        {{{"resize", {320, 240}}},
         {{"frames", 3}},
         {{"set", {{"panels", false}, {"tone", "none"}, {"exposure", 0}, {"background", "none"}}}},
         settled(),
         shot("off.png"),
         set("compare", "split"),
         passes(4),
         shot("split.png"),
         shot("split.exr"),
         set("split", 0.25),
         {{"frames", 2}},
         shot("quarter.png"),
         set("compare", "reference"),
         passes(16),
         shot("reference.png"),
         set("compare", "difference"),
         passes(12),
         shot("difference.png"),
         {{"set", {{"terms", 1}, {"residual", false}}}},
         {{"frames", 1}},
         passes(12),
         shot("difference-of-one.png"),
         {{"set", {{"terms", 0}, {"residual", true}}}},
         {{"set", {{"compare", "split"}, {"split", 0.5}}}},
         passes(1),
         {{"drag", "left"}, {"from", {200, 30}}, {"by", {40, 10}}, {"over", 4}},
         shot("orbited-at-once.png"),
         {{"frames", 1}},
         passes(4),
         shot("orbited.png"),
         {{"resize", {400, 300}}},
         {{"frames", 4}},
         passes(4),
         shot("small.png"),
         set("compare", "off"),
         {{"frames", 2}},
         shot("small-off.png"),
         {{"quit", true}}},
        "ring.relume room.exr");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK(isQuiet(outcome.err));
    const Outcome traced =
        session.relume(renderCommand(outcome.err, "split.exr")); // what is compared stays as it is
    REQUIRE_MESSAGE(traced.exitCode == 0, traced.err);
    CHECK(session.bytes("image.exr") == session.bytes("split.exr"));

    const auto image = [&](const char* file) { return windowImage(session.path(file)); };
    const Image off = image("off.png"), split = image("split.png"), quarter = image("quarter.png");
    const int half = kWidth / 2;
    CHECK_EQ(differingPixels(off, split, 0, half), 0);
    CHECK_GT(differingPixels(off, split, half, kWidth), 1000);
    CHECK_EQ(differingPixels(off, quarter, 0, half / 2), 0);
    CHECK_GT(differingPixels(off, quarter, half / 2, half), 500);

    // The same view, traced by another program from the same texels of light.
    std::string command = renderCommand(outcome.err, "split.exr");
    command.replace(0, 6, "reference");
    command.erase(command.find(" --coefficients"), std::string(" --coefficients 512").size());
    command += " --rays 1"; // per lighting texel instead of 4, to save time
    const Outcome reference = session.relume(command);
    REQUIRE_MESSAGE(reference.exitCode == 0, reference.err);
    const Image exact = toneMap(readImage(session.path("image.exr")).image, ToneCurve::None, 0);
    const Image shown = image("reference.png");
    const double noise = meanDifference(shown, exact), relit = meanDifference(off, exact);
    MESSAGE("mean difference of display values: reference " << noise << ", relit " << relit);
    CHECK_LT(noise, 0.02);
    CHECK_LT(noise, relit);

    const double heat = heatOf(image("difference.png")), heatOfOne = heatOf(image("difference-of-one.png"));
    MESSAGE("mean heat: all terms " << heat << ", one " << heatOfOne);
    CHECK_GT(heatOfOne, 1.1 * heat);

    // While the next reference is traced, the view alone.
    const Image atOnce = image("orbited-at-once.png"), orbited = image("orbited.png");
    CHECK_EQ(differingPixels(atOnce, orbited, 0, half), 0);
    CHECK_GT(differingPixels(atOnce, orbited, half, kWidth), 1000);
    CHECK_GT(differingPixels(off, orbited, 0, half), 1000);
    const Image small = image("small.png"), smallOff = image("small-off.png");
    REQUIRE_EQ(small.width, 400);
    CHECK_EQ(differingPixels(small, smallOff, 0, 200), 0);
    CHECK_GT(differingPixels(small, smallOff, 200, 400), 500);
}
