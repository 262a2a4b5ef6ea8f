// Bakes of an evaluation share the visibility of their vertices, and are none the worse for it.
#include "apps/evaluation/baked_scene.h"
#include "engine/transport/kept_visibility.h"
#include "tests/support/log_capture.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_device.h"

#include <doctest/doctest.h>
#include <sstream>

using namespace relume;
using namespace relume::test;

namespace {

// Of eight triangles on a ground.
constexpr const char* kOctahedron =
    "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
    "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";

BakeRecipe recipeOf(const TemporaryFolder& folder, const char* material, int terms) {
    BakeRecipe recipe{
        .name = "octahedron",
        .model = {"octahedron", folder.write("octahedron.obj", kOctahedron), UpAxis::Y, "1", ""},
        .material = material,
        .ground = GroundOptions{.tessellation = 8},
        .options = paperOptions(terms)};
    recipe.options.visibilitySize = 64;
    recipe.options.faceSize = 32;
    recipe.options.mapSize = 16;
    recipe.options.transportSamples = 4;
    return recipe;
}

// That a store has for a recipe, beside what the recipe shares.
std::filesystem::path onlyBake(const std::filesystem::path& folder, const std::filesystem::path& shared) {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".relume" && entry.path() != shared) return entry.path();
    return {};
}

size_t filesIn(const std::filesystem::path& folder) {
    return size_t(std::distance(std::filesystem::directory_iterator(folder), {}));
}

} // namespace

TEST_CASE("bake store: what shares visibility is what it is without") {
    const TestDevice device;
    const TemporaryFolder inputs, shared, own;
    const BakeRecipe first = recipeOf(inputs, "clay", 1), second = recipeOf(inputs, "red-plastic", 2);
    CHECK_EQ(first.visibilityKey(), second.visibilityKey());
    CHECK_NE(first.key(), second.key());

    const BakeStore store(device, shared.path()), alone(device, own.path());
    CHECK_FALSE(store.make(first).msPerVertex);
    const auto kept = store.visibilityPath(second);
    CHECK_FALSE(KeptVisibility(kept).key().empty());
    store.remove(first);
    REQUIRE(std::filesystem::exists(kept));
    const LogCapture log;
    const BakeRecord record = store.make(second);
    CHECK(log.says("vertices reused"));
    CHECK(KeptVisibility(onlyBake(shared.path(), kept)).key().empty());
    CHECK_FALSE(record.msPerVertex);
    CHECK_EQ(alone.makeTimed(second).bytes, record.bytes);
    CHECK(encodeAsset(store.read(second)) == encodeAsset(alone.read(second)));
    CHECK_FALSE(std::filesystem::exists(alone.visibilityPath(second)));

    store.remove(second);
    store.removeVisibility(second);
    CHECK_EQ(filesIn(shared.path()), 0u);
}

TEST_CASE("bake store: visibility that is no good is found anew, and kept") {
    const TestDevice device;
    const TemporaryFolder inputs, folder;
    const BakeStore store(device, folder.path());
    const BakeRecipe first = recipeOf(inputs, "clay", 1), second = recipeOf(inputs, "red-plastic", 1);
    const BakeRecord record = store.make(first);
    writeFileAtomically(store.visibilityPath(first), std::string("half of it"));
    const LogCapture log;
    CHECK_EQ(store.make(second).vertices, record.vertices);
    CHECK_FALSE(log.says("vertices reused"));
    CHECK_FALSE(KeptVisibility(store.visibilityPath(first)).key().empty());
}

TEST_CASE("bake store: a bake is timed only where it finds its visibility itself") {
    const TestDevice device;
    const TemporaryFolder inputs, folder;
    const BakeRecipe recipe = recipeOf(inputs, "clay", 1);
    const BakeStore store(device, folder.path());
    const BakeRecord made = store.make(recipe);
    const auto before = encodeAsset(store.read(recipe));
    CHECK_FALSE(store.make(recipe).msPerVertex);
    const LogCapture log;
    const BakeRecord timed = store.makeTimed(recipe);
    CHECK_FALSE(log.says("vertices reused"));
    REQUIRE(timed.msPerVertex);
    CHECK_GT(*timed.msPerVertex, 0);
    CHECK_EQ(timed.bytes, made.bytes);
    CHECK(encodeAsset(store.read(recipe)) == before);
    CHECK_EQ(*store.make(recipe).msPerVertex, *timed.msPerVertex); // it is there
    CHECK_EQ(*store.makeTimed(recipe).msPerVertex, *timed.msPerVertex);
    CHECK_FALSE(KeptVisibility(store.visibilityPath(recipe)).key().empty());
}
