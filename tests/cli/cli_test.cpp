// The program as its users meet it: exit codes, streams, files.
#include "tests/support/capture_binding.h"
#include "tests/support/run_relume.h"
#include "tests/support/validation.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace relume::test;

namespace {

// A bake small enough for a test of a second.
std::string smallBake(const TemporaryFolder& folder) {
    return "bake " + ballIn(folder) +
           " --ground --ground-tessellation 4 -K 2 -N 32 --bounces 0 --visibility-size 64 --face-size 32 "
           "--map-size 16 -q ";
}

} // namespace

TEST_CASE("cli: help and version go to stdout and end well") {
    const TemporaryFolder folder;
    const Outcome help = runRelume(folder, "--help");
    CHECK_EQ(help.exitCode, 0);
    for (const char* command : {"bake", "render", "reference", "compare", "verify", "info", "materials",
                                "brdf", "devices", "bench", "convert"}) {
        CHECK(says(help.out, command));
        const Outcome own = runRelume(folder, std::string(command) + " --help");
        CHECK_EQ(own.exitCode, 0);
        CHECK(says(own.out, "Usage"));
        for (const char* noise : {" in [", "{false}", "INT", "Excludes"}) CHECK(!says(own.out, noise));
        std::istringstream lines(own.out.substr(own.out.find("Options:")));
        for (std::string line; std::getline(lines, line);)
            if (line.starts_with("  ")) CHECK_MESSAGE(line.size() <= 104, line);
    }
    CHECK(says(runRelume(folder, "render --help").out, "--relight auto|full|incremental"));
    CHECK(says(runRelume(folder, "--version").out, "relume "));
}

TEST_CASE("cli: usage errors are 2, and name the option and what it takes") {
    const TemporaryFolder folder;
    const Outcome nothing = runRelume(folder, "");
    CHECK_EQ(nothing.exitCode, 2);
    CHECK(says(nothing.err, "Usage"));
    const Outcome unknown = runRelume(folder, "redner a.relume");
    CHECK_EQ(unknown.exitCode, 2);
    CHECK(says(unknown.err, "redner: no such command; did you mean render?"));
    CHECK_EQ(runRelume(folder, "bake").exitCode, 2); // no -o
    for (const auto& [arguments, part] : std::vector<std::pair<std::string, std::string>>{
             {"bake -o x.relume --terms 33", "1 to 32"},
             {"bake -o x.relume --coefficients 0", "--coefficients"},
             {"bake -o x.relume --face-size 48", "32 or 64"},
             {"bake -o x.relume --transport-samples 16 --bounces 0 --visibility-size 64",
              "--transport-samples"},
             {"bake -o x.relume --occluder some", "--occluder"},
             {"bake -o x.relume --material ashikmin-shirley", "ashikhmin-shirley"},
             {"bake -o x.relume --validation all", "core, sync, gpu, best"},
             {"bake -o x.png", ".relume"},
             {"bake -o x.relume --memory 0", "--memory"},
             {"bake -o x.relume --memory -5", "found \"-5\""},
             {"bake '' -o x.relume", "expected a value"},
             {"render x.relume -o x.png -e ''", "-e: expected a value"},
             {"render x.relume -o x.png --environment=", "--environment: expected a value"},
             {"bake -o x.relume --up z scene.json", "--up"},
             {"bake -o x.relume --ground-extent 2", "--ground"},
             {"brdf clay --terms 33", "1 to 32"},
             {"brdf clay --terms auto:nan", "auto:"},
             {"brdf clay --factorization svd", "nonnegative"},
             {"brdf clay --map equal", "equal-area"},
             {"brdf clay --terms 2 --factorization normalized", "one term"},
             {"bake -o x.relume --preset old", "old not in {default,paper}"},
             {"brdf clay --size 3", "--size"},
             {"brdf clay --size 8 --terms auto:0.1 --factorization nonnegative", "give their number"},
             {"brdf cley", "clay"},
             {"brdf clay --maps x.svg", ".png"},
             {"render x.relume -o x.jpg", ".exr or .png"},
             {"render x.relume -o x.png --rotate inf", "--rotate"},
             {"render x.relume -o x.png --orbit 0,nan,1", "--orbit"},
             {"render x.relume -o x.png --distant-light nan,0", "--distant-light"},
             {"render x.relume -o x.png --coefficients 0", "--coefficients"},
             {"render x.relume -o x.png --light l.json -e e.exr", "--environment"},
             {"render x.relume -o x.png --blend-weight 0.5", "--blend"},
             {"render x.relume -o x.png --coefficients 9 --threshold 9", "--threshold"},
             {"render x.relume -o x.png --intensity nan", "--intensity"},
             {"render x.relume -o x.png --fov nan", "--fov"},
             {"compare a.exr b.exr --threshold nan", "--threshold"},
             {"render x.relume -o x.png --size 0x4", "--size"},
             {"render x.relume -o x.png --tone film", "--tone"},
             {"render x.relume -o x.png --samples 3", "--samples"},
             {"reference x.relume -o x.png --samples 16", "--samples"},
             {"render x.relume -o x.png --timings x.txt", ".json (for trace viewers) or .csv"},
             {"reference x.relume -o x.exr --rays 3", "--rays"}}) {
        CAPTURE_BINDING(arguments);
        const Outcome outcome = runRelume(folder, arguments);
        CHECK_EQ(outcome.exitCode, 2);
        CHECK(says(outcome.err, part));
        CHECK(outcome.out.empty());
        CHECK_FALSE(std::filesystem::exists(folder.path() / "x.relume"));
    }
}

TEST_CASE("cli: bad input is 1, names the file, and leaves what was there alone") {
    const TemporaryFolder folder;
    std::ofstream(folder.path() / "broken.obj") << "v 0 0 nonsense\nf 1 2 3\n";
    std::ofstream(folder.path() / "empty.relume");
    std::ofstream(folder.path() / "old.relume") << "precious";
    const Outcome missing = runRelume(folder, "bake missing.obj -o old.relume");
    CHECK_EQ(missing.exitCode, 1);
    CHECK(says(missing.err, "missing.obj"));
    const Outcome broken = runRelume(folder, "bake broken.obj -o old.relume");
    CHECK_EQ(broken.exitCode, 1);
    CHECK(says(broken.err, "broken.obj"));
    CHECK_EQ(contents(folder.path() / "old.relume"), "precious");
    const Outcome empty = runRelume(folder, "info empty.relume");
    CHECK_EQ(empty.exitCode, 1);
    CHECK(says(empty.err, "empty.relume"));
    CHECK_EQ(runRelume(folder, smallBake(folder) + "-o nowhere/x.relume").exitCode, 1);
    std::filesystem::create_directory(folder.path() / "folder.relume");
    const Outcome onFolder = runRelume(folder, smallBake(folder) + "-o folder.relume");
    CHECK_EQ(onFolder.exitCode, 1);
    CHECK(says(onFolder.err, "folder.relume"));
    std::ofstream(folder.path() / "scene.json")
        << R"({"parts": [{"name": "ball", "mesh": "sphere", "material": "cley"}]})";
    const Outcome material = runRelume(folder, "bake scene.json -o x.relume");
    CHECK_EQ(material.exitCode, 1);
    for (const char* part : {"scene.json", "ball", "clay"}) CHECK(says(material.err, part));
}

TEST_CASE("cli: without a device the exit code is 4") {
    const TemporaryFolder folder;
    const std::string noDriver = "VK_DRIVER_FILES=/nonexistent.json VK_ICD_FILENAMES=/nonexistent.json";
    const Outcome bake = runRelume(folder, smallBake(folder) + "-o x.relume", noDriver);
    CHECK_EQ(bake.exitCode, 4);
    CHECK(says(bake.err, "Vulkan"));
    CHECK_EQ(runRelume(folder, "devices", noDriver).exitCode, 4);
    CHECK_EQ(runRelume(folder, smallBake(folder) + "-o x.relume --device no-such-device").exitCode, 4);
}

TEST_CASE("cli: materials lists presets and models, as text and as JSON") {
    const TemporaryFolder folder;
    const Outcome text = runRelume(folder, "materials");
    CHECK_EQ(text.exitCode, 0);
    for (const char* part : {"red-plastic", "oren-nayar", "roughness_u", "from 0.02 to 1", "measured"})
        CHECK(says(text.out, part));
    const Outcome outcome = runRelume(folder, "materials --json");
    REQUIRE_EQ(outcome.exitCode, 0);
    const auto materials = nlohmann::json::parse(outcome.out);
    CHECK_GT(materials["presets"].size(), 25u);
    CHECK_EQ(materials["models"][0]["parameters"][0]["name"], "albedo");
}

TEST_CASE("cli: brdf measures terms, after each of them, and draws them") {
    const TemporaryFolder folder;
    const Outcome outcome = runRelume(folder, "brdf red-plastic --size 12 --terms 6 --json --maps m.png");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    const auto brdf = nlohmann::json::parse(outcome.out);
    CHECK_EQ(brdf["terms"], 6);
    CHECK_EQ(brdf["map"], "equal-area");
    CHECK_EQ(brdf["material"]["model"], "plastic");
    CHECK_EQ(brdf["eigenvalues"].size(), 3u);
    for (const char* key :
         {"frobenius_residual", "rms_absolute", "rms_relative", "expected_radiance_error"}) {
        REQUIRE_EQ(brdf[key].size(), 6u);
        CHECK_LT(brdf[key][5].get<double>(), brdf[key][0].get<double>());
    }
    CHECK(contents(folder.path() / "m.png").starts_with("\x89PNG"));

    const Outcome paper = runRelume(folder, "brdf red-plastic --size 12 --factorization paper --json");
    CHECK_EQ(nlohmann::json::parse(paper.out)["map"], "orthographic");
    const Outcome automatic = runRelume(folder, "brdf red-plastic --size 12 --terms auto:0.05 --json");
    const auto few = nlohmann::json::parse(automatic.out);
    CHECK_LE(few["expected_radiance_error"].back().get<double>(), 0.05);
    REQUIRE_GE(few["terms"].get<size_t>(), 2u);
    CHECK_GT(few["expected_radiance_error"][few["terms"].get<size_t>() - 2].get<double>(), 0.05);
    CHECK(says(runRelume(folder, "brdf clay --size 8 --terms 2").out, "Frobenius"));
}

TEST_CASE(
    "cli: materials of a bake are bound, blended by weights over their sum, and named when there are none") {
    const TemporaryFolder folder;
    const std::string bake = smallBake(folder) + R"(-m clay -m '{"name": "a=1", "model": "plastic"}' )";
    REQUIRE_EQ(runRelume(folder, bake + "-o set.relume").exitCode, 0);
    const auto draws = [&](const std::string& materials) {
        const Outcome drawn = runRelume(folder, "render " + materials + " set.relume -o x.exr --size 24x18");
        CHECK_EQ(drawn.exitCode, 0); // options before the file do not swallow it
        return contents(folder.path() / "x.exr");
    };
    const std::string clay = draws(""), plastic = draws("-m a=1"), half = draws("-m clay -m a=1=1");
    CHECK(clay == draws("-m clay=3"));
    CHECK(half == draws("-m clay=.5 -m a=1=0.5"));
    CHECK(clay != plastic);
    CHECK(half != clay);
    const auto refuses = [&](const std::string& materials, const char* why) {
        const Outcome drawn = runRelume(folder, "render " + materials + " set.relume -o y.exr");
        CHECK_EQ(drawn.exitCode, 2);
        CHECK(says(drawn.err, why));
        CHECK_FALSE(std::filesystem::exists(folder.path() / "y.exr"));
    };
    refuses("-m cly", "did you mean \"clay\"");
    refuses("-m clay=0", "above 0");
    refuses("-m clay=-1", "0 or more");
    refuses("-m clay=nan", "0 or more");
    refuses("-m clay -m clay", "named twice");
}

TEST_CASE("cli: cameras and lights too small to be any are refused") {
    const TemporaryFolder folder;
    REQUIRE_EQ(runRelume(folder, smallBake(folder) + "-o a.relume").exitCode, 0);
    for (const auto& [arguments, part] :
         {std::pair("--orbit 0,0,1e-30", "--orbit: expected a distance"),
          {"--sphere-light 0,0,1e-30", "--sphere-light: expected a radius of 0.0001"},
          {"--eye 1,2,3 --target 1,2,3", "--eye: expected"}}) {
        const Outcome outcome = runRelume(folder, std::string("render a.relume -o x.exr ") + arguments);
        CHECK_EQ(outcome.exitCode, 2);
        CHECK(says(outcome.err, part));
    }
}

TEST_CASE("cli: names with control characters cannot command the terminal") {
    const TemporaryFolder folder;
    folder.write("scene.json",
                 R"({"parts": [{"name": "\u001b[2Jred", "mesh": "sphere", "material": "clay"}]})");
    const Outcome bake =
        runRelume(folder, "bake scene.json -K 1 -N 32 --bounces 0 --visibility-size 64 --face-size 32 "
                          "--map-size 16 -o a.relume");
    REQUIRE_EQ(bake.exitCode, 0);
    const Outcome info = runRelume(folder, "info a.relume");
    for (const std::string& text : {bake.err, info.out}) {
        CHECK(says(text, "\\x1b[2Jred"));
        CHECK_FALSE(says(text, "\x1b"));
    }
}

TEST_CASE("cli: what cannot be printed is a failure, also of help") {
    const TemporaryFolder folder;
    for (const char* arguments : {"--help", "--version", "bake --help", "materials"}) {
        const Outcome full = runProgram(folder, "/bin/sh",
                                        std::string("-c '" RELUME_PROGRAM " ") + arguments + " >/dev/full'");
        CHECK_EQ(full.exitCode, 1);
        CHECK(says(full.err, "is its disk full"));
    }
}

TEST_CASE("cli: a material that cannot be used is named before the work") {
    const TemporaryFolder folder;
    std::ofstream(folder.path() / "cut.binary") << "x";
    for (const auto& [material, part] :
         std::vector<std::pair<std::string, std::string>>{{"missing.binary", "missing.binary"},
                                                          {"cut.binary", "cut.binary"},
                                                          {"missing.json", "missing.json"}}) {
        const Outcome outcome = runRelume(folder, smallBake(folder) + ("-o x.relume -m " + material));
        CHECK_EQ(outcome.exitCode, 1);
        CHECK(says(outcome.err, part));
    }
}

TEST_CASE("cli: devices lists what a choice needs") {
    const TemporaryFolder folder;
    const Outcome outcome = runRelume(folder, "devices --json");
    REQUIRE_EQ(outcome.exitCode, 0);
    const auto devices = nlohmann::json::parse(outcome.out);
    REQUIRE_FALSE(devices.empty());
    for (const char* key : {"index", "name", "type", "driver", "uuid", "largest_storage_buffer", "usable"})
        CHECK(devices[0].contains(key));
    const std::string name = devices[0]["name"], uuid = devices[0]["uuid"];
    CHECK_EQ(runRelume(folder, smallBake(folder) + "-o a.relume --device " + uuid).exitCode, 0);
    CHECK_EQ(runRelume(folder, smallBake(folder) + "-o b.relume --device '" + name + "'").exitCode, 0);
    CHECK_EQ(contents(folder.path() / "a.relume"), contents(folder.path() / "b.relume"));
}

TEST_CASE("cli: from a bake to pictures, measurements and numbered frames, without a validation message") {
    const TemporaryFolder folder;
    const std::string validated = " --validation " + relume::testValidation();
    const Outcome bake = runRelume(folder, smallBake(folder) + "-o a.relume --timings t.json" + validated);
    CAPTURE(bake.err);
    REQUIRE_EQ(bake.exitCode, 0);
    CHECK(nlohmann::json::parse(contents(folder.path() / "t.json")).contains("stages"));

    const Outcome info = runRelume(folder, "info a.relume --json");
    REQUIRE_EQ(info.exitCode, 0);
    CHECK(says(info.out, "gold"));
    CHECK(nlohmann::json::parse(info.out).is_object());
    const std::string readable = runRelume(folder, "info a.relume").out;
    CHECK(readable.starts_with("a.relume: "));
    CHECK(says(readable.substr(0, readable.find("\n\n")), " in gold"));
    CHECK(says(readable, "provenance"));

    folder.write("l.json", R"({"sky": {"sun": {"azimuth": 40, "elevation": 30}},
                              "lamps": [{"azimuth": 200, "elevation": 40, "radius": 5, "radiance": [20, 10, 5]}]})");
    for (const std::string light :
         {"", "--distant-light 30,60", "--sphere-light 30,60,5", "--light l.json --rotate 20"}) {
        const Outcome render =
            runRelume(folder, "render a.relume -o a.exr --size 64x48 " + light + validated);
        CAPTURE(render.err);
        REQUIRE_EQ(render.exitCode, 0);
        CHECK_EQ(says(render.err, "patchy shadows"), says(light, "-light ") && !says(light, "l.json"));
        REQUIRE_EQ(runRelume(folder, "reference a.relume -o b.exr --size 64x48 " + light).exitCode, 0);
        const Outcome compare = runRelume(folder, "compare a.exr b.exr --json");
        REQUIRE_EQ(compare.exitCode, 0);
        const auto difference = nlohmann::json::parse(compare.out);
        for (const char* key : {"relative_rmse", "psnr", "max_difference", "flip"})
            CHECK(difference.contains(key));
        CHECK_GT(difference["relative_rmse"].get<double>(), 0);
        CHECK_EQ(runRelume(folder, "compare a.exr b.exr --threshold 1e-6").exitCode, 3);
        CHECK_EQ(runRelume(folder, "compare a.exr a.exr --threshold 1e-6").exitCode, 0);
    }
    REQUIRE_EQ(runRelume(folder, "render a.relume -o turn.png --size 32x24 --frames 3 --turn light").exitCode,
               0);
    for (const char* frame : {"turn_0001.png", "turn_0002.png", "turn_0003.png"})
        CHECK(contents(folder.path() / frame).starts_with("\x89PNG"));
    // A frame that another thread cannot write ends the program as one that it cannot write itself.
    std::filesystem::create_directory(folder.path() / "hit_0002.png");
    const Outcome hit = runRelume(folder, "render a.relume -o hit.png --size 32x24 --frames 40 --turn light");
    CHECK_EQ(hit.exitCode, 1);
    CHECK(says(hit.err, "hit_0002.png: cannot be written: it is a folder"));

    const Outcome verify = runRelume(folder, "verify a.relume --samples 10 --json" + validated);
    REQUIRE_EQ(verify.exitCode, 0);
    CHECK_EQ(nlohmann::json::parse(verify.out)["relight_bits"], 0);
}

TEST_CASE("cli: bench bake prints every path's figures as JSON") {
    const TemporaryFolder folder;
    const std::string scene = "sphere --ground --ground-tessellation 4 -K 2 -N 32 --visibility-size 64 "
                              "--face-size 32 --map-size 16 --vertices 40 --repeats 1 ";
    const Outcome outcome = runRelume(folder, "bench bake " + scene + "--json");
    REQUIRE_EQ(outcome.exitCode, 0);
    const auto found = nlohmann::json::parse(outcome.out);
    CHECK_EQ(found["repeats"], 1);
    CHECK_GE(found["threads"], 1);
    CHECK_EQ(found["options"]["coefficients"], 32);
    uint64_t sampled = 0;
    for (const auto& part : found["scene"]["parts"]) sampled += part["sampled"].get<uint64_t>();
    CHECK_EQ(found["vertices"], sampled);
    CHECK_GT(found["bandwidth"]["device_gb_per_s"], 0);
    CHECK_GT(found["bandwidth"]["host_gb_per_s"], 0);
    for (const auto& [path, throughput] :
         {std::pair("cpu", "rays_per_second"), std::pair("raster", "triangles_per_second"),
          std::pair("traced", "rays_per_second")}) {
        CAPTURE_BINDING(path);
        const auto& figures = found["paths"][path];
        CHECK_GT(figures["ms_per_vertex"], 0);
        CHECK_GT(figures["ratio_to_cpu"], 0);
        CHECK_GT(figures[throughput], 0);
        // The same rows but for silhouettes and exchanges at the N-th place: equal work.
        CHECK_LE(figures["difference_to_cpu"], 0.1);
        double stages = 0;
        for (const auto& stage : figures["stages"]) {
            stages += stage["ms_per_vertex"].get<double>();
            if (stage.contains("bytes_per_vertex")) CHECK_GT(stage["floor_ms_per_vertex"], 0);
        }
        CHECK(stages == doctest::Approx(figures["ms_per_vertex"].get<double>()).epsilon(0.02));
    }
    CHECK_EQ(found["paths"]["cpu"]["ratio_to_cpu"], 1);
    CHECK_EQ(found["paths"]["cpu"]["difference_to_cpu"], 0);
    CHECK_GT(found["paths"]["raster"]["difference_to_cpu"], 0); // truly another implementation's

    const Outcome table = runRelume(folder, "bench bake " + scene);
    CHECK_EQ(table.exitCode, 0);
    CHECK(says(table.out, "raster"));
    CHECK(says(table.out, "triangles per second"));
    const Outcome misplaced = runRelume(folder, "bench --json bake " + scene);
    CHECK_EQ(misplaced.exitCode, 2);
    CHECK(says(misplaced.err, "--json"));
    CHECK_EQ(runRelume(folder, "bench bake --vertices 0").exitCode, 2);
    CHECK_EQ(runRelume(folder, "bench bake --visibility raster").exitCode, 2);
}
