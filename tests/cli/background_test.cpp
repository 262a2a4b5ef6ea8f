// What is behind the object, how it is exposed, and where the ground ends.
#include "engine/import/image_file.h"
#include "engine/import/texture_file.h"
#include "engine/scene/texture.h"
#include "tests/support/capture_binding.h"
#include "tests/support/run_relume.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <fmt/core.h>

using namespace relume;
using namespace relume::test;

namespace {

const TemporaryFolder& bakes() {
    static const TemporaryFolder folder;
    if (std::filesystem::exists(folder.path() / "a.relume")) return folder;
    const std::string options =
        " -K 2 -N 32 --bounces 0 --visibility-size 64 --face-size 32 --map-size 16 -q -o ";
    REQUIRE_EQ(runRelume(folder, "bake " + ballIn(folder) + " --ground --ground-tessellation 4" + options +
                                     "a.relume")
                   .exitCode,
               0);
    REQUIRE_EQ(runRelume(folder, "bake " + ballIn(folder) + options + "bare.relume").exitCode, 0);
    Image map(32, 16); // red above, with green towards +Z, and blue below
    for (int y = 0; y < map.height; y++)
        for (int x = 0; x < map.width; x++)
            map.at(x, y) = y < 8 ? vec4(8, x >= 8 && x < 24 ? 6 : 1, 1, 1) : vec4(0.5f, 0.5f, 4, 1);
    writeExr(folder.path() / "map.exr", map);
    return folder;
}

std::string words(const std::string& command, const std::string& options,
                  const std::string& bake = "a.relume") {
    const std::string view = says(options, "--orbit") ? "" : " --orbit 30,5,1.6";
    const Outcome outcome =
        runRelume(bakes(), command + " " + bake + " --size 48x36 -e map.exr " + options + view);
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    return outcome.err;
}

struct Pixel {
    int r, g, b, a;
};

Pixel pixel(const std::string& file, int x, int y) {
    const Texture image = readTexture(bakes().path() / file, false);
    const uint32_t texel = image.texels.at(size_t(y) * size_t(image.width) + size_t(x));
    return {int(texel & 255), int(texel >> 8 & 255), int(texel >> 16 & 255), int(texel >> 24)};
}

std::string bytes(const std::string& file) { return contents(bakes().path() / file); }

} // namespace

TEST_CASE("cli: a picture shows the environment behind the object, linear radiance does not") {
    words("render", "-o picture.png");
    words("render", "-o said.png --background environment --ground-style shadow --exposure auto");
    CHECK(bytes("picture.png") == bytes("said.png"));
    const Pixel sky = pixel("picture.png", 2, 1);
    CHECK_GT(sky.r, sky.b + 30);
    CHECK_EQ(sky.a, 255);
    words("render", "-o blurred.png --background-blur 20 --exposure 0");
    words("render", "-o sharp.png --exposure 0");
    CHECK(bytes("blurred.png") != bytes("sharp.png"));

    words("render", "-o linear.exr");
    words("render", "-o none.exr --background none --ground-style whole");
    CHECK(bytes("linear.exr") == bytes("none.exr"));
    const Image linear = readImage(bakes().path() / "linear.exr").image;
    CHECK_EQ(linear.at(2, 1), vec4(0));
    words("render", "-o over.exr --background environment --ground-style whole");
    const Image over = readImage(bakes().path() / "over.exr").image;
    CHECK_EQ(over.at(24, 18), linear.at(24, 18));
    CHECK(over.at(2, 1).x == doctest::Approx(8).epsilon(0.01));
    CHECK_EQ(over.at(2, 1).w, 1);
    CHECK(over.at(2, 1).y == doctest::Approx(1).epsilon(0.01)); // the eye looks towards -Z
    CHECK_GT(over.at(2, 16).z, over.at(2, 16).x);               // below the horizon
    for (const char* command : {"render", "reference --rays 1"}) {
        CAPTURE(command);
        words(command, "-o turned.exr --background environment --rotate 180");
        CHECK(readImage(bakes().path() / "turned.exr").image.at(2, 1).y == doctest::Approx(6).epsilon(0.01));
    }
}

TEST_CASE("cli: a picture has no background, or an even one") {
    words("render", "-o none.png --background none");
    CHECK_EQ(pixel("none.png", 2, 1).a, 0);
    CHECK_EQ(pixel("none.png", 24, 18).a, 255);
    for (const char* color : {"#336699", "0.2,0.4,0.6"}) {
        words("render", fmt::format("-o even.png --background '{}'", color));
        const Pixel behind = pixel("even.png", 2, 1);
        CHECK_EQ(behind.r, 0x33);
        CHECK_EQ(behind.g, 0x66);
        CHECK_EQ(behind.b, 0x99);
        CHECK_EQ(behind.a, 255);
    }
    for (const auto& [options, part] : std::vector<std::pair<std::string, std::string>>{
             {"-o x.png --background '#12345'", "#rrggbb"},
             {"-o x.png --background '#12345g'", "#rrggbb"},
             {"-o x.png --background 0.1,0.2", "r,g,b"},
             {"-o x.png --background 0.1,0.2,1.2", "r,g,b"},
             {"-o x.png --background 0.1,0.2,nan", "r,g,b"},
             {"-o x.png --background blue", "found \"blue\""},
             {"-o x.exr --background '#123456'", "write .png"},
             {"-o x.exr --background-blur 3", "--background environment"},
             {"-o x.png --background none --background-blur 3", "--background environment"},
             {"-o x.png --background-blur -1", "0 to 90"},
             {"-o x.png --exposure bright", "--exposure"},
             {"-o x.png --exposure 101", "--exposure"}})
        for (const char* command : {"render", "reference"}) {
            CAPTURE_BINDING(options);
            const Outcome outcome = runRelume(bakes(), std::string(command) + " a.relume " + options);
            CHECK_EQ(outcome.exitCode, 2);
            CHECK_MESSAGE(says(outcome.err, part), outcome.err);
        }
}

TEST_CASE("cli: exposure is the object's own, told as a number that says the same, and one for all frames") {
    const std::string told = words("render", "-o auto.png");
    const std::string mark = "--exposure=";
    const size_t start = told.find(mark);
    REQUIRE_NE(start, std::string::npos);
    const std::string stops = told.substr(start, told.find(' ', start) - start);
    words("render", "-o number.png " + stops);
    CHECK(bytes("auto.png") == bytes("number.png"));
    // Twice the light, half the exposure.
    words("render", "-o bright.png --intensity 2");
    CHECK(bytes("bright.png") == bytes("auto.png"));
    words("render", "-o f.png --frames 3 --turn both");
    words("render", "-o g.png --frames 3 --turn both " + stops);
    for (int frame = 1; frame <= 3; frame++)
        CHECK(bytes(fmt::format("f_{:04}.png", frame)) == bytes(fmt::format("g_{:04}.png", frame)));
    // The reference finds about the same.
    const std::string exact = words("reference", "-o exact.png --rays 1");
    const size_t place = exact.find(mark);
    REQUIRE_NE(place, std::string::npos);
    CHECK(std::stod(exact.substr(place + mark.size())) ==
          doctest::Approx(std::stod(stops.substr(mark.size()))).epsilon(0.2));
}

TEST_CASE("cli: the ground ends around the object, in the reference too") {
    words("render", "-o faded.exr --samples 1 --ground-style fade --orbit 30,60,2.5");
    words("render", "-o whole.exr --samples 1 --orbit 30,60,2.5");
    words("reference", "-o exact.exr --rays 1 --samples 1 --ground-style fade --orbit 30,60,2.5");
    const Image faded = readImage(bakes().path() / "faded.exr").image,
                whole = readImage(bakes().path() / "whole.exr").image,
                exact = readImage(bakes().path() / "exact.exr").image;
    int part = 0, gone = 0;
    for (size_t i = 0; i < faded.pixels.size(); i++) {
        const vec4 &f = faded.pixels[i], &w = whole.pixels[i];
        if (w.w < 1) continue; // the object's or the ground's edge
        for (int c = 0; c < 3; c++) CHECK(f[c] == doctest::Approx(f.w * w[c]).epsilon(1e-4));
        part += f.w > 0.05f && f.w < 0.95f;
        gone += f.w < 0.05f;
        if (exact.pixels[i].w > 0) CHECK(f.w == doctest::Approx(exact.pixels[i].w).epsilon(0.02));
    }
    CHECK_GT(part, 50);
    CHECK_GT(gone, 20);
    CHECK_EQ(faded.at(24, 18), whole.at(24, 18));
    for (const char* style : {"fade", "shadow"}) {
        const Outcome bare =
            runRelume(bakes(), fmt::format("render bare.relume -o x.exr --ground-style {}", style));
        CHECK_EQ(bare.exitCode, 2);
        CHECK(says(bare.err, "bake with --ground"));
    }
    words("render", "-o bare.png", "bare.relume"); // nothing to fade is no error where nobody asks for it
}

TEST_CASE("cli: the ground's shadow darkens the background, as the reference's does") {
    REQUIRE_EQ(runRelume(bakes(), "bake " + ballIn(bakes()) +
                                      " --ground --ground-tessellation 64 -K 2 -N 256 --bounces 0 "
                                      "--visibility-size 64 --face-size 32 --map-size 16 -q -o fine.relume")
                   .exitCode,
               0);
    const std::string shadow = "--samples 1 --ground-style shadow --orbit 30,40,1.4";
    words("render", "-o shadow.exr " + shadow, "fine.relume");
    words("reference", "-o exact.exr " + shadow, "fine.relume");
    words("render", "-o whole.exr --samples 1 --orbit 30,40,1.4", "fine.relume");
    const Image drawn = readImage(bakes().path() / "shadow.exr").image,
                exact = readImage(bakes().path() / "exact.exr").image,
                whole = readImage(bakes().path() / "whole.exr").image;
    words("reference", "-o sampled.exr --noise 0.02 " + shadow, "fine.relume");
    const Image sampled = readImage(bakes().path() / "sampled.exr").image;
    double noise = 0;
    for (size_t i = 0; i < exact.pixels.size(); i++) {
        const vec4 difference = sampled.pixels[i] - exact.pixels[i];
        noise += double(difference.w * difference.w);
    }
    CHECK_LT(std::sqrt(noise / double(exact.pixels.size())), 0.01);
    double squares = 0;
    int dark = 0, light = 0, object = 0, ground = 0;
    for (size_t i = 0; i < drawn.pixels.size(); i++) {
        const vec4 d = drawn.pixels[i], e = exact.pixels[i];
        if (vec3(d) != vec3(0)) {
            CHECK_EQ(d, whole.pixels[i]); // the object is drawn as ever
            object++;
        } else if (vec3(e) == vec3(0) && whole.pixels[i].w > 0) {
            squares += double((d.w - e.w) * (d.w - e.w));
            ground++;
            dark += e.w > 0.3f;
            light += e.w < 0.03f;
        }
    }
    CHECK_GT(object, 100);
    CHECK_GT(dark, 20);
    CHECK_GT(light, 200);
    CHECK_LT(std::sqrt(squares / ground), 0.02);
    // From below the ground hides nothing.
    const std::string below = "--samples 1 --background none --orbit 30,-30,1.4";
    words("render", "-o bare.exr " + below, "bare.relume");
    const Image bare = readImage(bakes().path() / "bare.exr").image;
    for (const char* command : {"render", "reference --rays 1", "reference --noise 0.5"}) {
        CAPTURE(command);
        words(command, "-o below.exr --ground-style shadow " + below, "fine.relume");
        const Image seen = readImage(bakes().path() / "below.exr").image;
        int differing = 0;
        for (size_t i = 0; i < seen.pixels.size(); i++) differing += seen.pixels[i].w != bare.pixels[i].w;
        CHECK_LT(differing, 5);
    }
    // A picture is the background times what is left of its light.
    words("render", "-o over.exr --background environment " + shadow, "fine.relume");
    const Image over = readImage(bakes().path() / "over.exr").image;
    const auto darkest =
        std::ranges::max_element(drawn.pixels, {}, [](vec4 p) { return vec3(p) == vec3(0) ? p.w : 0.0f; });
    const auto place = size_t(darkest - drawn.pixels.begin());
    words("render", "-o behind.exr --samples 1 --background environment --orbit 30,40,1.4", "bare.relume");
    const vec4 behind = readImage(bakes().path() / "behind.exr").image.pixels[place];
    CHECK(over.pixels[place].z == doctest::Approx((1 - darkest->w) * behind.z).epsilon(0.02));
}
