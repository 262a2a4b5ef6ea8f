// What an evaluation keeps and finds again, what it looks for, and how it states errors.
#include "apps/evaluation/measured_error.h"
#include "apps/evaluation/scene_inputs.h"
#include "apps/evaluation/step_store.h"
#include "tests/support/temporary_folder.h"

#include <doctest/doctest.h>

using namespace relume;
using namespace relume::test;

namespace {

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

} // namespace

TEST_CASE("step store: a result is found again by its name and key") {
    const TemporaryFolder folder;
    folder.write("a.txt", "a");
    const StepStore store(folder.path());
    CHECK_FALSE(store.find("step", "key"));
    store.store("step", "key", {{{"value", 0.1}}, {"a.txt"}});
    const auto found = StepStore(folder.path()).find("step", "key");
    REQUIRE(found);
    CHECK_EQ(found->numbers.at("value"), 0.1);
    CHECK_EQ(found->files, std::vector<std::string>{"a.txt"});
    CHECK_FALSE(store.find("other", "key"));
    CHECK_FALSE(store.find("step", "another key"));
}

TEST_CASE("step store: a result is made anew where its file or one of its files is damaged") {
    const TemporaryFolder folder;
    const StepStore store(folder.path());
    const auto storeAgain = [&] {
        folder.write("a.txt", "a");
        store.store("step", "key", {{{"value", 1}}, {"a.txt"}});
        REQUIRE(store.find("step", "key"));
    };
    storeAgain();
    folder.write("a.txt", "b");
    CHECK_FALSE(store.find("step", "key"));
    storeAgain();
    std::filesystem::remove(folder.path() / "a.txt");
    CHECK_FALSE(store.find("step", "key"));
    storeAgain();
    const auto path = folder.path() / "steps" / "step.json";
    for (const char* text :
         {"", "{", "[]", "null", "{\"key\": \"key\"}", "{\"key\": \"key\", \"numbers\": 1}",
          "{\"key\": 3, \"numbers\": 1, \"files\": {}}",
          "{\"key\": \"key\", \"numbers\": 1, \"files\": {\"a.txt\": 3}}",
          "{\"key\": \"key\", \"numbers\": 1, \"files\": \"a.txt\"}", "\xff\xfe"}) {
        CAPTURE(text);
        folder.write("steps/step.json", text);
        CHECK_FALSE(store.find("step", "key"));
    }
}

TEST_CASE("scene inputs: what is missing is named with where it was looked for, once") {
    const TemporaryFolder folder;
    SceneInputs inputs(folder.path(), false);
    CHECK_FALSE(inputs.model("lucy"));
    CHECK_FALSE(inputs.model("lucy"));
    CHECK_FALSE(inputs.environment("uffizi"));
    REQUIRE_EQ(inputs.missing().size(), 2u);
    CHECK(says(inputs.missing()[0], "Lucy"));
    CHECK(says(inputs.missing()[0], (folder.path() / "meshes" / "lucy*").string()));
    CHECK(says(inputs.missing()[1], (folder.path() / "environments" / "uffizi*").string()));
    SceneInputs none("", false);
    CHECK_FALSE(none.model("dragon"));
    CHECK(says(none.missing().at(0), "--data"));
}

TEST_CASE("scene inputs: files are found by how their names begin, and told apart by their content") {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "meshes");
    folder.write("meshes/buddha_b.obj", "b");
    folder.write("meshes/buddha_a.obj", "a");
    SceneInputs inputs(folder.path(), true);
    const auto buddha = inputs.model("buddha");
    REQUIRE(buddha);
    CHECK_EQ(buddha->file.filename(), "buddha_a.obj");
    CHECK(buddha->up == UpAxis::Z);
    CHECK(buddha->standsFor.empty());
    CHECK(inputs.missing().empty());
    folder.write("meshes/buddha_a.obj", "c");
    CHECK_NE(SceneInputs(folder.path(), true).model("buddha")->hash, buddha->hash);
}

TEST_CASE("scene inputs: a stand-in says what it stands for") {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "meshes");
    folder.write("meshes/bunny.obj", "b");
    SceneInputs inputs(folder.path(), true);
    const auto dragon = inputs.model("dragon");
    REQUIRE(dragon);
    CHECK_EQ(describe(*dragon), "bunny, standing for dragon");
    REQUIRE_EQ(inputs.missing().size(), 1u);
    CHECK(says(inputs.missing()[0], "stands for it"));
    CHECK_FALSE(SceneInputs(folder.path(), false).model("dragon"));
}

TEST_CASE("measured error: relative to the truth, with twice the standard error either way") {
    ReferenceError found{.rmse = 0.2, .level = 2, .noise = 0.1, .square = 0.04, .squareNoise = 0.001};
    const MeasuredError error = measuredError(found);
    CHECK(error.value == doctest::Approx(0.1));
    CHECK(error.low == doctest::Approx(std::sqrt(0.038) / 2));
    CHECK(error.high == doctest::Approx(std::sqrt(0.042) / 2));
    CHECK_EQ(textOf(error), "10.0 % (9.7 to 10.2)");
    found.square = found.rmse = 0;
    CHECK_EQ(textOf(measuredError(found)), "at most 2.2 %");
    CHECK_EQ(measuredError({}).value, 0);
}

TEST_CASE("measured error: what differs by less than its noise is not told apart") {
    const auto error = [](double square, double noise) {
        return measuredError(
            {.rmse = std::sqrt(square), .level = 1, .noise = 0, .square = square, .squareNoise = noise});
    };
    CHECK(areDistinguishable(error(0.04, 0.001), error(0.044, 0.001)));
    CHECK_FALSE(areDistinguishable(error(0.04, 0.001), error(0.042, 0.001)));
    CHECK_FALSE(areDistinguishable(error(0.04, 0.001), error(0.04, 0.001)));
}

TEST_CASE("measured error: JSON gives it back") {
    const nlohmann::ordered_json json = MeasuredError{0.1, 0.05, 0.2};
    const auto back = json.get<MeasuredError>();
    CHECK_EQ(back.value, 0.1);
    CHECK_EQ(back.low, 0.05);
    CHECK_EQ(back.high, 0.2);
}
