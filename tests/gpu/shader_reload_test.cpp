// Shaders compiled again while a program runs, from copies of their sources.
#include "apps/viewer/shader_compiler.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/vk/shader_replacement.h"
#include "shaders/frame_shaders.h"
#include "tests/support/displayed.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_device.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <fmt/core.h>
#include <set>

using namespace relume;

namespace {

std::string readText(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = readFile(path);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::span<const uint32_t> builtIn(std::string_view file) {
    const auto* shader = std::ranges::find(kFrameShaders, file, &FrameShader::file);
    REQUIRE(shader != std::end(kFrameShaders));
    return shader->spirv;
}

// What expectSameInterface() says against this source in the place of a built-in shader; empty: nothing.
std::string complaint(std::string_view file, const std::vector<uint32_t>& spirv) {
    try {
        vk::expectSameInterface(std::string(file), builtIn(file), spirv);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

} // namespace

TEST_CASE("shader reload: all shaders that a frame uses are known") {
    const std::filesystem::path engine = shaderFolder().parent_path() / "engine";
    constexpr std::string_view kInclude = "#include \"shaders/", kEnd = ".h\"\n";
    std::set<std::string> used, known;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(engine)) {
        // engine/vk has the list of portable shaders, which are no others.
        if (!entry.is_regular_file() || entry.path().parent_path().filename() == "vk") continue;
        const std::string text = readText(entry.path());
        for (size_t at = 0; (at = text.find(kInclude, at)) != std::string::npos;) {
            at += kInclude.size();
            std::string name = text.substr(at, text.find(kEnd, at) - at);
            if (name.find('/') != std::string::npos) continue;     // shaders/shared, shaders/lib
            constexpr std::string_view kSamples = "_samples_frag"; // another macro, the same file
            if (name.ends_with(kSamples))
                name.replace(name.size() - kSamples.size(), kSamples.size(), "_frag");
            name[name.rfind('_')] = '.';
            used.insert(name);
        }
    }
    for (const FrameShader& shader : kFrameShaders) known.insert(std::string(shader.file));
    CHECK_FALSE(used.empty());
    CHECK_EQ(known, used);
}

TEST_CASE("shader reload: interfaces are told as C++ and the other stage see them") {
    const auto display = vk::describeInterface(builtIn("display.frag"));
    CHECK_EQ(display.at("stage"), "fragment");
    CHECK_EQ(display.at("push constants"), "{{float3 background @0; float scale @12} @0}");
    CHECK_EQ(display.at("binding 0"), "sampled image of float, dimension 1, layers");
    CHECK_EQ(display.at("output 0"), "float4");
    CHECK_EQ(display.at("constant 0"), "uint");
    CHECK_EQ(display.size(), 5);
    const auto lamps = vk::describeInterface(builtIn("light_lamps.comp"));
    CHECK_EQ(lamps.at("binding 2"), "storage buffer {float3[] @0}");
    CHECK_EQ(vk::describeInterface(builtIn("light_haar.comp")).at("constant 0"), "uint");
    CHECK_EQ(vk::describeInterface(builtIn("view_triangle_id.vert")).at("output 0"), "uint");
    CHECK_THROWS_AS(vk::describeInterface(std::vector<uint32_t>{1, 2, 3}), Error);
    const auto vertex = builtIn("display.vert");
    CHECK_NE(complaint("display.frag", {vertex.begin(), vertex.end()}), "");
}

#ifdef RELUME_GLSLANG

namespace {

// A copy of the sources to change; relume's own are left alone.
class Sources {
  public:
    Sources() { std::filesystem::copy(shaderFolder(), folder(), std::filesystem::copy_options::recursive); }

    std::filesystem::path folder() const { return mFolder.path() / "shaders"; }

    // Replaces the one place where a file says `old`, and returns the line it is on.
    size_t edit(const std::string& file, const std::string& old, const std::string& text) const {
        std::string source = readText(folder() / file);
        const size_t at = source.find(old);
        REQUIRE_NE(at, std::string::npos);
        REQUIRE_EQ(source.find(old, at + 1), std::string::npos);
        const auto line = size_t(std::count(source.begin(), source.begin() + ptrdiff_t(at), '\n')) + 1;
        writeFileAtomically(folder() / file, source.replace(at, old.size(), text));
        return line;
    }

    std::vector<uint32_t> compile(const std::string& file) const { return compileShader(folder() / file); }

    // The error that reloading ends with.
    std::string failure(vk::Device& device) const {
        try {
            reloadShaders(device, folder());
        } catch (const Error& error) {
            return error.what();
        }
        FAIL("expected an error");
        return "";
    }

  private:
    test::TemporaryFolder mFolder;
};

bool contains(const std::string& text, const std::string& part) {
    CAPTURE(text);
    return text.find(part) != std::string::npos;
}

// All shaders are those that a device takes at first.
bool isUnchanged(const vk::Device& device) {
    const vk::Device fresh;
    return std::ranges::all_of(kFrameShaders, [&](const FrameShader& shader) {
        return device.shader(shader.spirv) == fresh.shader(shader.spirv);
    });
}

constexpr const char* kShowBackground = "? push.background :";
constexpr const char* kShowInverse = "? 1 - push.background :";

} // namespace

TEST_CASE("shader reload: sources give the built-in shaders, word for word") {
    for (const FrameShader& shader : kFrameShaders) {
        CAPTURE(shader.file);
        const std::vector<uint32_t> compiled =
            compileShader(shaderFolder() / shader.file, {&shader.macro, 1});
        CHECK(std::ranges::equal(compiled, shader.spirv));
        CHECK_EQ(vk::describeInterface(compiled), vk::describeInterface(shader.spirv));
    }
}

TEST_CASE("shader reload: errors are told with file and line, and change nothing") {
    vk::Device device;
    const Sources sources;
    sources.edit("display.frag", kShowBackground, kShowInverse); // comes before what fails
    const size_t line =
        sources.edit("view_triangle_id.frag", "void main() {", "void main() {\n    seen = nothing;\n") + 1;
    const std::string failure = sources.failure(device);
    CHECK(contains(failure, fmt::format("{}:{}: 'nothing'",
                                        (sources.folder() / "view_triangle_id.frag").string(), line)));
    CHECK_FALSE(contains(failure, "ERROR"));
    CHECK(isUnchanged(device));

    const Sources included;
    const size_t deep = included.edit("lib/tone_map.glsl", "vec3 toneMap(", "vec3 toneMap(nothing,");
    CHECK(contains(included.failure(device),
                   fmt::format("{}:{}: ", (included.folder() / "lib/tone_map.glsl").string(), deep)));

    const Sources missing;
    std::filesystem::remove(missing.folder() / "lib/tone_map.glsl");
    CHECK(contains(missing.failure(device), "shaders/lib/tone_map.glsl"));
    std::filesystem::remove(missing.folder() / "display.frag");
    CHECK(contains(missing.failure(device), "display.frag"));

    const Sources endless;
    endless.edit("display.frag", "#include \"shaders/lib/tone_map.glsl\"", "#include \"display.frag\"");
    CHECK(contains(endless.failure(device), "display.frag"));

    CHECK_THROWS_WITH_AS(reloadShaders(device, "/nowhere/shaders"), doctest::Contains("/nowhere/shaders"),
                         Error);
    CHECK(isUnchanged(device));
}

TEST_CASE("shader reload: what C++ was not built for is refused") {
    vk::Device device;
    const Sources push;
    push.edit("display.frag", kShowBackground, kShowInverse);
    push.edit("shared/render.h", "struct DisplayPush {", "struct DisplayPush {\n    float more;");
    CHECK(contains(push.failure(device), "display.frag: push constants: found {{float more @0; "));
    const Sources swapped; // as many bytes
    swapped.edit("shared/render.h",
                 "    vec3 background; // display values\n    float scale;     // factor on radiance before "
                 "the curve\n",
                 "    float scale;\n    vec3 background;\n");
    CHECK(contains(swapped.failure(device), "display.frag: push constants: found {{float scale @0; "));
    CHECK(isUnchanged(device));

    const auto edited = [](const std::string& file, const std::string& old, const std::string& text) {
        const Sources sources;
        sources.edit(file, old, text);
        return complaint(file, sources.compile(file));
    };
    const Sources more;
    more.edit("display.frag", "layout(location = 0)",
              "layout(binding = 1) uniform sampler2D other;\nlayout(location = 0)");
    more.edit("display.frag", kShowBackground, "? texture(other, vec2(0)).rgb :");
    CHECK(contains(
        complaint("display.frag", more.compile("display.frag")),
        "binding 1: found sampled image of float, dimension 1, but this program was built for nothing"));
    CHECK(
        contains(edited("display.frag", "layout(binding = 0)", "layout(set = 1, binding = 0)"), "binding 0"));
    CHECK(contains(edited("display.frag", "uniform sampler2DArray", "uniform usampler2DArray"), "binding 0"));
    CHECK(contains(edited("light_sky.comp", "local_size_x", "local_size_y"), "group size"));
    CHECK(contains(edited("light_haar.comp", "layout(constant_id = 0) const uint", "const uint"),
                   "constant 0"));
    CHECK(contains(edited("view_triangle_id.frag", "in uint triangleId;",
                          "in float triangleId;\n#define triangleId uint(triangleId)"),
                   "input 0"));
    CHECK_EQ(edited("display.frag", kShowBackground, kShowInverse), "");
    // A shader may stop reading an image that is bound to it.
    CHECK_EQ(edited("display.frag", "texelFetch(image, ivec3(gl_FragCoord.xy, 0), 0)", "vec4(1)"), "");
}

TEST_CASE("shader reload: programs made afterwards draw with what changed") {
    vk::Device device(
        {.select = "", .validation = testValidation(), .surfaceExtensions = {}, .pipelineCache = {}});
    const Image nothing(8, 8); // shows the background alone
    const DisplayOptions options{.background = vec3(0.2f)};
    const auto shown = [&] { return test::displayed(device, nothing, options).pixels[0].x; };
    CHECK_EQ(shown(), doctest::Approx(0.2f));
    CHECK_EQ(reloadShaders(device, shaderFolder()), 0);

    const Sources sources;
    sources.edit("display.frag", kShowBackground, kShowInverse);
    CHECK_EQ(reloadShaders(device, sources.folder()), 1);
    CHECK_EQ(shown(), doctest::Approx(0.8f));
    CHECK_EQ(reloadShaders(device, sources.folder()), 0); // they are in use
    CHECK_EQ(shown(), doctest::Approx(0.8f));
    sources.edit("display.frag", "texelFetch(image, ivec3(gl_FragCoord.xy, 0), 0)",
                 "vec4(min(push.scale, 0))");
    CHECK_EQ(reloadShaders(device, sources.folder()), 1); // reads no image
    CHECK_EQ(shown(), doctest::Approx(0.8f));
    CHECK_EQ(reloadShaders(device, shaderFolder()), 1); // as they were built
    CHECK_EQ(shown(), doctest::Approx(0.2f));
    CHECK_EQ(device.validationMessages(), 0);
}

#else

TEST_CASE("shader reload: without a compiler it says so") {
    vk::Device device;
    CHECK_THROWS_WITH_AS(reloadShaders(device, shaderFolder()), doctest::Contains("built without glslang"),
                         Error);
}

#endif
