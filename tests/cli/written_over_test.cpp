// No command writes over what it reads, nor over its own output.
#include "tests/support/run_relume.h"

#include "engine/import/image_file.h"

#include <doctest/doctest.h>
#include <map>

using namespace relume;
using namespace relume::test;

namespace {

// What commands read, and links to it.
struct InputFolder : TemporaryFolder {
    InputFolder() {
        write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n");
        write("scene.json", R"({"parts": [{"mesh": "mesh.obj", "material": "material.json"}]})");
        write("material.json", R"({"model": "diffuse"})");
        std::filesystem::create_directory(path() / "images");
        Image map(8, 4);
        for (vec4& pixel : map.pixels) pixel = vec4(1);
        writeExr(path() / "images/drawn.exr", map);
        std::filesystem::create_symlink("images/drawn.exr", path() / "map.png");
        std::filesystem::create_symlink("material.json", path() / "material.png");
        std::filesystem::create_symlink(path(), path() / "here");
        const Outcome bake = run("bake mesh.obj" + std::string(kSmall) + "--keep-visibility -o a.relume");
        REQUIRE_MESSAGE(bake.exitCode == 0, bake.err);
    }

    static constexpr const char* kSmall =
        " -K 1 -N 8 --layout rows --bounces 0 --visibility-size 64 --face-size 32 --map-size 8 -q ";

    Outcome run(const std::string& arguments) const { return runRelume(*this, arguments, kNoThreads); }

    // All files by name, but for what programs say.
    std::map<std::string, std::string> files() const {
        std::map<std::string, std::string> found;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(path()))
            if (entry.is_regular_file() && entry.path().filename() != "out.txt" &&
                entry.path().filename() != "err.txt")
                found[entry.path()] = contents(entry.path());
        return found;
    }
};

} // namespace

TEST_CASE("cli: no command writes over what it reads, or twice to a file") {
    const InputFolder folder;
    const auto before = folder.files();
    const std::string small = InputFolder::kSmall;
    for (const std::string& arguments : std::initializer_list<std::string>{
             "bake mesh.obj -o b.relume --timings mesh.obj" + small,
             "bake mesh.obj -o b.relume --timings b.relume" + small,
             "bake mesh.obj -o b.relume --timings here/b.relume" + small,
             "bake mesh.obj -o a.relume --timings a.relume" + small,
             "bake mesh.obj -m material.json -o b.relume --timings ./material.json" + small,
             "bake scene.json -o b.relume --timings scene.json" + small,
             "bake scene.json -o b.relume --timings mesh.obj" + small,
             "bake scene.json -o b.relume --timings material.png" + small,
             "rebake a.relume -o b.relume --timings a.relume",
             "rebake a.relume -o b.relume --timings here/b.relume",
             "rebake a.relume -o a.relume --timings a.relume",
             "rebake a.relume -m material.json -o b.relume --timings material.json",
             "merge a.relume -o here/a.relume",
             "convert a.relume -o ./a.relume",
             "render a.relume -e images/drawn.exr -o images/drawn.exr",
             "render a.relume -e images/drawn.exr -o map.png",
             "reference a.relume -e images/drawn.exr -o images/drawn.exr",
             "verify a.relume -e images/drawn.exr --visibility-image map.png",
             "errors a.relume -e images/drawn.exr --images here/images",
             "brdf material.json --maps material.png"}) {
        CAPTURE(arguments);
        const Outcome outcome = folder.run(arguments);
        CHECK_EQ(outcome.exitCode, 2);
        CHECK((says(outcome.err, "written over") || says(outcome.err, "writes too")));
        CHECK((folder.files() == before));
    }
    // What is meant to be replaced is.
    const Outcome same = folder.run("rebake a.relume -m gold -o a.relume -q --timings times.json");
    CHECK_MESSAGE(same.exitCode == 0, same.err);
    CHECK(contents(folder.path() / "a.relume") != before.at(folder.path() / "a.relume"));
    CHECK(std::filesystem::exists(folder.path() / "times.json"));
}
