// Errors taken apart, and advice in words.
#include "tests/support/run_relume.h"

#include <doctest/doctest.h>
#include <fstream>
#include <nlohmann/json.hpp>

using namespace relume::test;
using Json = nlohmann::json;

namespace {

Json errorsOf(const TemporaryFolder& folder, const std::string& arguments) {
    return Json::parse(succeed(folder, "errors " + arguments + " --json").out);
}

double rms(const Json& errors, const char* source) { return errors["sources"][source]["rms"]; }

} // namespace

TEST_CASE("errors: the sources sum to what is measured, in rows and bases") {
    const TemporaryFolder folder;
    succeed(folder, "bake " + ballIn(folder) +
                        " --ground --ground-tessellation 10 -m ashikhmin-shirley -K 3 -N 48 "
                        "--bounces 0 --visibility-size 64 --map-size 24 --layout rows -q -o rows.relume");
    succeed(folder, "convert rows.relume --layout bases --error 0.2 -q -o bases.relume");
    const Json rows = errorsOf(folder, "rows.relume --size 16x12"),
               bases = errorsOf(folder, "bases.relume --size 16x12");
    for (const Json& errors : {rows, bases}) {
        CAPTURE(errors.dump(2));
        const double measured = errors["measured"], total = errors["total"];
        CHECK(measured > 0.02);
        CHECK(std::abs(total - measured) < 0.15 * measured);
        CHECK(rms(errors, "drawing") < 0.3 * measured);
        CHECK(rms(errors, "drawing") > 0);
        CHECK(errors["unexplained_truth"].get<double>() < 0.3 * measured);
        double shares = 0;
        for (const Json& source : errors["sources"]) shares += source["share"].get<double>();
        CHECK(shares == doctest::Approx(1).epsilon(1e-6));
    }
    CHECK(rms(bases, "storage") > 3 * rms(rows, "storage"));
    CHECK(rms(bases, "terms") == doctest::Approx(rms(rows, "terms")));

    const Json all = errorsOf(folder, "rows.relume --size 8x6 --threshold 0"),
               few = errorsOf(folder, "rows.relume --size 8x6 --threshold 4000");
    CHECK(rms(all, "light_selection") < 0.1 * rms(few, "light_selection"));

    // What three terms leave of this material is a multiple of what is left of that with the residual.
    const Json terms = errorsOf(folder, "rows.relume --size 8x6 --residual off");
    CHECK(rms(terms, "terms") > 2 * rms(all, "terms"));
    CHECK(rms(terms, "drawing") < 1e-3);
}

TEST_CASE("errors: images and heat maps of every source are written") {
    const TemporaryFolder folder;
    succeed(folder, "bake " + ballIn(folder) +
                        " -m clay -K 1 --bounces 0 --visibility-size 64 --face-size 32 --map-size 16 -q "
                        "-o a.relume");
    succeed(folder, "errors a.relume --size 8x6 --images images");
    for (const char* name : {"drawn.exr", "reference.exr", "harmonics.exr", "total.png", "terms.png",
                             "interpolation.png", "visibility.png"})
        CHECK(std::filesystem::file_size(folder.path() / "images" / name) > 50);
}

TEST_CASE("errors: what it cannot look at is said") {
    const TemporaryFolder folder;
    succeed(folder, "bake " + ballIn(folder) +
                        " -m clay -K 1 --bounces 0 --visibility-size 64 --face-size 32 --map-size 16 -q "
                        "-o a.relume");
    const auto fails = [&](const std::string& arguments, int code, const std::string& what) {
        const Outcome outcome = runRelume(folder, arguments, kNoThreads);
        CAPTURE(outcome.err);
        CHECK_EQ(outcome.exitCode, code);
        CHECK(says(outcome.err, what));
    };
    fails("errors a.relume --size 16x12 --eye 9,0,0 --target 99,0,0", 2, "another view");
    fails("errors a.relume --size 9000x9000", 2, "--size");
    std::ofstream(folder.path() / "dark.json") << R"({"lamps": []})";
    fails("errors a.relume --size 16x12 --light dark.json", 1, "black");
    // Before the work: so many pixels take minutes.
    fails("errors a.relume --size 500x500 --light dark.json", 1, "the light is black");
    fails("errors a.relume --size 500x500 --images a.relume/inside", 1, "cannot be written");
    fails("advise sphere", 2, "--error");
    fails("advise sphere --error 0", 2, "--error");
}

TEST_CASE("advise: options in words and as data, and what to do where there are none") {
    const TemporaryFolder folder;
    folder.write("octahedron.obj",
                 "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
                 "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n");
    const Outcome words =
        succeed(folder, "advise octahedron.obj -m white-diffuse --as-is --points 40 --error 0.2");
    CHECK(says(words.out, "of fewest bytes: relume bake … --terms 1 --factorization environment"));
    CHECK(says(words.out, "--layout rows --coefficients"));
    folder.write("ball.obj", sampleObj(relume::makeSphere(1)));
    // A sphere shadows nothing, so that one term and what it leaves are nearly exact.
    const Json data =
        Json::parse(succeed(folder, "advise ball.obj -m clay --as-is --points 40 --error 0.1 --json").out);
    CHECK_EQ(data["asked"], 0.1);
    CHECK_EQ(data["best"], data["plain"]["bases"]["options"]);
    CHECK(says(data["best"].get<std::string>(), "--terms 1 --factorization environment --error"));
    const Outcome none = runRelume(
        folder, "advise octahedron.obj -m ashikhmin-shirley --as-is --points 40 --error 0.001", kNoThreads);
    CHECK_EQ(none.exitCode, 1);
    CHECK(says(none.err, "not reached"));
    CHECK(says(none.out, "least error by terms"));
}
