// Readers of JSON that people write. The first byte of an input chooses: 0: the rest is a scene file; 1: a
// light file; 2: a material, or a list of them. The files that these may name are in a folder.
#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/import/builtin_mesh.h"
#include "engine/import/image_file.h"
#include "engine/import/light_file.h"
#include "engine/import/scene.h"
#include "precompute/brdf/material_list.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/mesh_samples.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/texture_samples.h"
#include "tests/support/textured_glb.h"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

namespace relume::test {

namespace {

enum Kind { kScene, kLight, kMaterial, kKinds };

class Files {
  public:
    Files() {
        const Texture texture{2, 1, {0xff0000ff, 0xff00ff80}, true};
        mFolder.write("a.obj", sampleObj(makeSphere(0)));
        mFolder.write("a.glb", TexturedGlb().bytes());
        mFolder.write("a.png", samplePng(texture));
        mFolder.write("m.json", R"({"set": ["clay", {"name": "coat", "model": "plastic"}]})");
        Image image(4, 2);
        image.pixels.assign(8, vec4(1, 0.5f, 0.25f, 1));
        for (const char* name : {"a.exr", "s1.exr", "s2.exr"}) writeExr(path() / name, image);
    }

    const std::filesystem::path& path() const { return mFolder.path(); }

  private:
    TemporaryFolder mFolder;
};

// Returns whether a scene asks for more than a fuzzer has time for: it is the user's right.
bool isLarge(std::string_view text) {
    const auto json = nlohmann::json::parse(text, nullptr, false);
    if (!json.is_object()) return false;
    const auto parts = json.find("parts"), ground = json.find("ground");
    if (parts != json.end() && parts->is_array() && parts->size() > 4) return true;
    if (ground == json.end() || !ground->is_object()) return false;
    const auto quads = ground->find("tessellation");
    return quads != ground->end() && quads->is_number() && quads->get<double>() > 64;
}

void runScene(const Files& files, std::string_view text) {
    if (isLarge(text)) return;
    const std::filesystem::path path = files.path() / "scene.json";
    std::ofstream(path, std::ios::binary).write(text.data(), std::streamsize(text.size()));
    for (const Part& part : readScene(path, {.tessellation = 4}).parts) {
        RELUME_CHECK(!part.mesh.triangles.empty());
        RELUME_CHECK_EQ(part.mesh.normals.size(), part.mesh.positions.size());
        for (const vec3& position : part.mesh.positions)
            for (int axis = 0; axis < 3; axis++) RELUME_CHECK(std::isfinite(position[axis]));
        if (part.baseColor || part.materialMap)
            RELUME_CHECK_EQ(part.mesh.uvs.size(), part.mesh.positions.size());
    }
}

void runLight(const Files& files, std::string_view text) {
    MovingLight light(text, "light.json", files.path());
    for (const double seconds : {0.0, 1.5, 1e6}) {
        const Light now = light.at(seconds);
        for (const Lamp& lamp : now.lamps)
            for (int c = 0; c < 3; c++)
                RELUME_CHECK(std::isfinite(lamp.radiance[c]) && lamp.radiance[c] >= 0);
        for (const EnvironmentLight& environment : now.environments) RELUME_CHECK(environment.map != nullptr);
    }
}

void runMaterial(const Files& files, std::string_view text) {
    const vec3 up(0, 0, 1), aslant = glm::normalize(vec3(0.5f, -0.25f, 0.1f));
    for (const auto& set : readMaterials(std::string(text), files.path()))
        for (const auto& [name, brdf] : set) {
            RELUME_CHECK(!name.empty());
            const auto again = makeBrdf(brdf->describe().dump());
            for (const auto& [in, out] :
                 {std::pair(up, aslant), std::pair(aslant, up), std::pair(aslant, aslant)}) {
                const vec3 value = brdf->evaluate(in, out);
                for (int c = 0; c < 3; c++) RELUME_CHECK(std::isfinite(value[c]) && value[c] >= 0);
                RELUME_CHECK(again->evaluate(in, out) == value);
            }
        }
}

void run(std::span<const std::byte> input) {
    static const Files files;
    const int kind = input.empty() ? kScene : int(input[0]) % kKinds;
    const std::string_view text = textOf(input.subspan(std::min<size_t>(input.size(), 1)));
    try {
        if (kind == kScene) runScene(files, text);
        if (kind == kLight) runLight(files, text);
        if (kind == kMaterial) runMaterial(files, text);
    } catch (const Error&) {
    }
}

std::vector<Bytes> seeds() {
    return {seedOf({kScene}, R"({"parts": [{"mesh": "a.glb", "name": "b", "scale": 2, "rotate": [0, 90, 0],
                "translate": [1, 0, -1]}, {"mesh": "a.obj", "up": "z", "material": {"model": "plastic"},
                "brush_rotation": 30}], "ground": {"tessellation": 8, "extent": 3, "material": "clay"}})"),
            seedOf({kScene}, R"({"parts": [{"mesh": "plane", "material": "m.json", "base_color": "a.png",
                "material_map": "a.png"}], "ground": true})"),
            seedOf({kLight}, R"({"environment": {"file": "a.exr", "rotate": 30, "gain": 2}, "blend":
                {"sequence": "s#.exr", "rate": 2, "weight": {"keys": [[0, 0], [2, 1]], "repeat": true}},
                "lamps": [{"azimuth": 40, "elevation": 35, "radius": 5, "radiance": [20, 18, 15]}],
                "distant": [{"azimuth": 0, "elevation": 90, "irradiance": [1, 1, 1]}]})"),
            seedOf({kLight}, R"({"sky": {"time": "2024-06-21T12:00", "latitude": 48, "longitude": 11,
                "turbidity": 3, "hours_per_second": {"keys": [[0, 0], [1, 2]]}}, "strokes": [{"azimuth": 0,
                "elevation": 20, "radius": 15, "radiance": [1, 0, 0], "softness": 0.5, "opacity": 0.5}]})"),
            seedOf({kMaterial}, R"({"separate": ["clay", {"set": [{"name": "coat", "model": "plastic"},
                "gold"]}, "m.json"]})"),
            seedOf({kMaterial}, R"({"model": "ashikhmin-shirley", "nu": 10, "nv": 100})"),
            seedOf({kMaterial}, R"({"model": "ggx", "f0": 0.5, "roughness": 0.25})")};
}

const AddFuzzTarget kAdded({"json", run, seeds});

} // namespace
} // namespace relume::test
