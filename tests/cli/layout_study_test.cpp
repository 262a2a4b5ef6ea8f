// The experiment that docs/layouts.md is made by, on a bake that takes no time.
#include "engine/import/image_file.h"
#include "tests/support/run_relume.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <sstream>

using namespace relume;
using namespace relume::test;

namespace {

// The table's lines that begin with the name.
std::string linesOf(const TemporaryFolder& folder, const std::string& bakes, const std::string& name) {
    const Outcome outcome =
        runProgram(folder, RELUME_LAYOUT_STUDY,
                   bakes + " -e sky=map.exr --rows 8,16 --budgets 60 --width 24 --height 16");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    std::istringstream table(contents(folder.path() / "layouts.csv"));
    std::string found;
    for (std::string line; std::getline(table, line);)
        if (line.starts_with('"' + name + '"')) found += line + '\n';
    return found;
}

} // namespace

TEST_CASE("cli: the layout study measures every layout, each bake against a reference of its own") {
    const TemporaryFolder folder;
    Image map(8, 4);
    for (size_t i = 0; i < map.pixels.size(); i++) map.pixels[i] = vec4(float(i), 2, 1, 1);
    writeExr(folder.path() / "map.exr", map);
    folder.write("solid.obj", "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
                              "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n");
    const auto bake = [&](const std::string& options) {
        const Outcome outcome =
            runRelume(folder, "bake solid.obj --refine off -K 2 -N 32 --layout rows --visibility-size 64 "
                              "--map-size 16 -q " +
                                  options);
        CAPTURE(outcome.err);
        REQUIRE_EQ(outcome.exitCode, 0);
    };
    bake("--face-size 64 -o fine.relume");
    bake("--face-size 32 -o coarse.relume");
    const std::string alone = linesOf(folder, "coarse=coarse.relume", "coarse");
    CHECK_EQ(std::ranges::count(alone, '\n'), 5); // source, two of rows, clusters, bases
    for (const char* layout : {"source", "rows", "clusters", "bases"}) CHECK(says(alone, layout));
    CHECK_FALSE(says(alone, "nan"));
    // Of the same shape, after another whose lights are finer.
    CHECK(linesOf(folder, "fine=fine.relume coarse=coarse.relume", "coarse") == alone);
    for (const char* plot : {"layouts_relit.svg", "layouts_image.svg"})
        CHECK(says(contents(folder.path() / plot), "<svg"));
}
