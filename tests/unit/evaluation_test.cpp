// What an evaluation keeps and finds again, what it looks for, and how it states numbers.
#include "apps/evaluation/evaluation_folder.h"
#include "apps/evaluation/measured_error.h"
#include "apps/evaluation/range_text.h"
#include "apps/evaluation/scene_inputs.h"
#include "apps/evaluation/step_store.h"
#include "engine/base/error.h"
#include "tests/support/temporary_folder.h"

#include <doctest/doctest.h>

using namespace relume;
using namespace relume::test;

namespace {

using Json = nlohmann::ordered_json;

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

Json readResult(const TemporaryFolder& folder) {
    std::ifstream file(folder.path() / "steps" / "step.json");
    return Json::parse(file);
}

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

TEST_CASE("step store: numbers that are not those that were stored are no result") {
    const TemporaryFolder folder;
    const StepStore store(folder.path());
    store.store("step", "key", {{{"a", 0.1}, {"b", {1, -2.5e-9}}, {"c", nullptr}}, {}});
    REQUIRE(store.find("step", "key"));
    CHECK(store.find("step", "key")->isIntact);
    Json result = readResult(folder);
    result["numbers"] = Json::object();
    folder.write("steps/step.json", result.dump());
    CHECK_FALSE(store.find("step", "key"));
    // As earlier versions stored it.
    result.erase("numbers_hash");
    folder.write("steps/step.json", result.dump());
    REQUIRE(store.find("step", "key"));
    CHECK_FALSE(store.find("step", "key")->isIntact);
}

TEST_CASE("step store: files outside of the folder are not looked at") {
    const TemporaryFolder folder;
    const auto inner = folder.path() / "inner";
    std::filesystem::create_directories(inner / "images");
    folder.write("outside.txt", "a");
    folder.write("inner/images/a.txt", "a");
    const StepStore store(inner);
    store.store("step", "key", {1, {"images/a.txt"}});
    REQUIRE(store.find("step", "key"));
    std::ifstream file(inner / "steps" / "step.json");
    Json result = Json::parse(file);
    const std::string hash = result["files"]["images/a.txt"];
    for (const std::string& path : {std::string("../outside.txt"), std::string("images/../../outside.txt"),
                                    (folder.path() / "outside.txt").string()}) {
        CAPTURE(path);
        result["files"] = {{path, hash}};
        folder.write("inner/steps/step.json", result.dump());
        CHECK_FALSE(store.find("step", "key"));
    }
}

TEST_CASE("step store: tells whether names that begin so have results") {
    const TemporaryFolder folder;
    const StepStore store(folder.path());
    CHECK_FALSE(store.hasAny("table-1-"));
    store.store("table-1-bunny", "key", {1, {}});
    CHECK(store.hasAny("table-1-"));
    CHECK_FALSE(store.hasAny("table-2-"));
}

TEST_CASE("evaluation folder: one evaluation at a time has it") {
    const TemporaryFolder folder;
    const auto inner = folder.path() / "a" / "b";
    {
        const FolderLock lock(inner);
        CHECK_THROWS_WITH_AS(FolderLock{inner}, doctest::Contains("another evaluation"), Error);
    }
    const FolderLock again(inner);
    CHECK(std::filesystem::is_empty(inner));
    folder.write("file", "");
    CHECK_THROWS_WITH_AS(makeFolder(folder.path() / "file" / "c"), doctest::Contains("file/c"), Error);
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

TEST_CASE("scene inputs: what no reader knows is passed over") {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "meshes" / "dragon.obj");
    std::filesystem::create_directories(folder.path() / "environments");
    for (const char* name : {"meshes/lucy.mtl", "meshes/lucy.txt", "meshes/lucy_b.PLY",
                             "environments/grace.txt", "environments/rnl.hdr"})
        folder.write(name, name);
    SceneInputs inputs(folder.path(), false);
    REQUIRE(inputs.model("lucy"));
    CHECK_EQ(inputs.model("lucy")->file.filename(), "lucy_b.PLY");
    CHECK_FALSE(inputs.model("dragon"));
    CHECK_FALSE(inputs.environment("grace"));
    REQUIRE(inputs.environment("rnl"));
    CHECK_EQ(inputs.environment("rnl")->file.filename(), "rnl.hdr");
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

TEST_CASE("ranges: told by their ends in three digits") {
    CHECK_EQ(rangeText({}), "-");
    CHECK_EQ(rangeText({1.5}), "1.5");
    CHECK_EQ(rangeText({2.004, 1.996}), "2");
    CHECK_EQ(rangeText({3, 0.12345, 1234.5}), "0.123 to 1234");
}
