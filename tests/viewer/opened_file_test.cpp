// Files that are opened, and names of files that are written.
#include "apps/viewer/opened_file.h"
#include "apps/viewer/outputs.h"
#include "tests/support/temporary_folder.h"

#include <cstdlib>
#include <doctest/doctest.h>
#include <fstream>
#include <set>

using namespace relume;
using namespace relume::test;

namespace {

// A folder that is the home of caches, and the folder that programs run in.
struct OpenedFolder : TemporaryFolder {
    OpenedFolder() : mBefore(std::filesystem::current_path()) {
        setenv("XDG_CACHE_HOME", (path() / "cache").c_str(), 1);
        std::filesystem::current_path(path());
    }
    ~OpenedFolder() {
        std::filesystem::current_path(mBefore);
        unsetenv("XDG_CACHE_HOME");
    }

  private:
    std::filesystem::path mBefore;
};

} // namespace

TEST_CASE("opened file: its bake is another once it, or a file that it names, has changed") {
    const OpenedFolder folder;
    folder.write("house.gltf",
                 R"({"buffers": [{"uri": "the%20house.bin"}], "images": [{"uri": "wall.png"}]})");
    folder.write("the house.bin", "corners");
    folder.write("wall.png", "texels");
    folder.write("scene.json", R"({"parts": [{"mesh": "house.gltf"}, {"mesh": "scene.json"}]})");
    for (const char* opened : {"house.gltf", "scene.json"}) {
        CAPTURE(opened);
        std::set<std::filesystem::path> bakes = {bakePath(opened)};
        CHECK_EQ(bakePath(opened), *bakes.begin());
        for (const char* changed : {"house.gltf", "the house.bin", "wall.png"}) {
            CAPTURE(changed);
            const auto date = std::filesystem::last_write_time(changed);
            std::ofstream(changed, std::ios::app) << " ";
            std::filesystem::last_write_time(changed, date); // as after a clock went back
            CHECK(bakes.insert(bakePath(opened)).second);
            std::filesystem::last_write_time(changed, date + std::chrono::seconds(1));
            CHECK(bakes.insert(bakePath(opened)).second);
        }
    }
    CHECK_THROWS_WITH(bakePath("nowhere.obj"), "nowhere.obj: cannot be read: No such file or directory");
}

TEST_CASE("outputs: a name is that of no file that is there") {
    const OpenedFolder folder;
    for (int i = 0; i < 50; i++) { // several in a millisecond
        const std::string name = outputName(".png");
        CAPTURE(name);
        CHECK_FALSE(std::filesystem::exists(name));
        std::ofstream(name) << "picture";
    }
}
