// The libraries as they are installed: programs of others find them, build against them, and draw what
// `relume render` does.
#include "engine/base/file.h"
#include "engine/import/image_file.h"
#include "tests/support/run_relume.h"
#include "tests/support/temporary_folder.h"

#include <cstring>
#include <doctest/doctest.h>
#include <fmt/core.h>

using namespace relume;
using namespace relume::test;

namespace {

// What a program said that must succeed.
std::string run(const TemporaryFolder& folder, const std::string& program, const std::string& arguments,
                const std::string& environment = "") {
    const Outcome outcome = runProgram(folder, program, arguments, environment);
    CAPTURE(program);
    CAPTURE(arguments);
    CAPTURE(outcome.err);
    REQUIRE(outcome.exitCode == 0);
    return outcome.out;
}

// A color PFM of rows from the bottom, as foreign_frame writes it.
std::vector<vec3> readPfm(const std::filesystem::path& path, int width, int height) {
    const std::vector<std::byte> bytes = readFile(path);
    const std::string header = fmt::format("PF\n{} {}\n-1\n", width, height);
    std::vector<vec3> rows(size_t(width) * size_t(height)), pixels;
    REQUIRE(bytes.size() == header.size() + rows.size() * sizeof(vec3));
    REQUIRE(std::memcmp(bytes.data(), header.data(), header.size()) == 0);
    std::memcpy(rows.data(), bytes.data() + header.size(), rows.size() * sizeof(vec3));
    for (int y = height; y-- > 0;)
        pixels.insert(pixels.end(), rows.begin() + y * width, rows.begin() + (y + 1) * width);
    return pixels;
}

} // namespace

TEST_CASE("examples build against what is installed, and draw what relume render does") {
    const TemporaryFolder folder;
    run(folder, RELUME_CMAKE, "--install '" RELUME_BUILD "' --prefix usr --component dev");
    run(folder, RELUME_CMAKE,
        "-S '" RELUME_SOURCE "/apps/examples' -B build -DCMAKE_PREFIX_PATH=\"$PWD/usr\" "
        "-DCMAKE_CXX_FLAGS='-Wall -Wextra -Werror " RELUME_FLAGS "'");
    run(folder, RELUME_CMAKE, "--build build");
    const std::string foreignFrame = (folder.path() / "build/foreign_frame").string(),
                      turningLight = (folder.path() / "build/turning_light").string();
    run(folder, RELUME_PROGRAM,
        "bake " + ballIn(folder) +
            " --ground --ground-tessellation 10 -m gold -K 2 --visibility-size 64 -o bake.relume");

    // In a foreign frame, to the bit; the validation layer has nothing to say.
    CHECK(run(folder, foreignFrame, "bake.relume frame.pfm",
              "VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation") == "");
    run(folder, RELUME_PROGRAM, "render bake.relume --size 640x480 -o frame.exr");
    const Image image = readImage(folder.path() / "frame.exr").image;
    const std::vector<vec3> frame = readPfm(folder.path() / "frame.pfm", image.width, image.height);
    size_t different = 0, covered = 0;
    for (size_t i = 0; i < frame.size(); i++) {
        different += frame[i] != vec3(image.pixels[i]);
        covered += image.pixels[i].w > 0;
    }
    CHECK(different == 0);
    CHECK(covered > frame.size() / 20);

    // A program that links the runtime alone has none of the readers.
    const std::string libraries = run(folder, "ldd", foreignFrame),
                      symbols = run(folder, "nm", "-C " + foreignFrame);
    for (const char* reader :
         {"OpenEXR", "tinygltf", "tinyobj", "meshoptimizer", "embree", "libpng", "libstb"})
        CHECK_MESSAGE(!says(libraries, reader), reader);
    for (const char* reader : {"nlohmann", "tinygltf", "tinyobj", "Imf_", "rtcNew", "spdlog", "Eigen::"})
        CHECK_MESSAGE(!says(symbols, reader), reader);

    // The other turns its light.
    run(folder, RELUME_PROGRAM, "render bake.relume --size 64x32 -o sky.exr");
    run(folder, turningLight, "bake.relume sky.exr 2");
    CHECK(readFile(folder.path() / "turning_light_000.png") !=
          readFile(folder.path() / "turning_light_001.png"));
}
