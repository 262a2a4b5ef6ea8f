// `relume evaluate` on a small mesh: a report is written, what is done is not done twice, what is stopped
// goes on.
#include "tests/support/run_relume.h"

#include <csignal>
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <spawn.h>

using namespace relume::test;

namespace {

// A bunny of eight triangles.
constexpr const char* kOctahedron =
    "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
    "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";

void writeData(const TemporaryFolder& folder) {
    std::filesystem::create_directories(folder.path() / "data" / "meshes");
    folder.write("data/meshes/bunny.obj", kOctahedron);
}

size_t filesIn(const std::filesystem::path& folder) {
    if (!std::filesystem::exists(folder)) return 0;
    return size_t(std::distance(std::filesystem::directory_iterator(folder), {}));
}

const std::string kTable = "evaluate --quick --data data --only table-1 -o out";

// Starts it in the folder and gives its process.
pid_t startRelume(const TemporaryFolder& folder, const std::string& arguments) {
    const std::string command = "cd '" + folder.path().string() + "' && exec '" RELUME_PROGRAM "' " +
                                arguments + " >out.txt 2>err.txt </dev/null";
    const char* values[] = {"sh", "-c", command.c_str(), nullptr};
    pid_t process = 0;
    REQUIRE_EQ(posix_spawn(&process, "/bin/sh", nullptr, nullptr, const_cast<char**>(values), environ), 0);
    return process;
}

} // namespace

TEST_CASE("cli: evaluate writes a report with what is missing, and does nothing twice") {
    const TemporaryFolder folder;
    writeData(folder);
    const Outcome first = runRelume(folder, kTable);
    REQUIRE_EQ(first.exitCode, 0);
    CHECK(says(first.err, "2 steps, 0 of them done before"));
    const auto out = folder.path() / "out";
    const std::string report = contents(out / "report.html"),
                      table = contents(out / "tables" / "table_1.csv");
    CHECK(says(report, "Table 1"));
    CHECK(says(report, "Pentium 4"));
    CHECK(says(report, "data/meshes/lucy*"));
    CHECK_FALSE(says(report, "Table 2"));
    CHECK(says(report, "What was found"));
    CHECK(says(table, "bunny,4,"));
    CHECK(says(table, ",paper's MB,"));
    CHECK_EQ(filesIn(out / "bakes"), 0u);

    const Outcome second = runRelume(folder, kTable);
    REQUIRE_EQ(second.exitCode, 0);
    CHECK(says(second.err, "2 steps, 2 of them done before"));
    CHECK_FALSE(says(second.err, "step 1"));
    CHECK_EQ(contents(out / "tables" / "table_1.csv"), table);

    folder.write("out/steps/table-1-bunny-k1.json", "{");
    const Outcome third = runRelume(folder, kTable);
    REQUIRE_EQ(third.exitCode, 0);
    CHECK(says(third.err, "2 steps, 1 of them done before"));
    CHECK(says(third.err, "step 1 of 2"));
    CHECK_FALSE(says(third.err, "step 2 of 2"));

    folder.write("data/meshes/bunny.obj", std::string(kOctahedron) + "v 5 5 5\n");
    CHECK(says(runRelume(folder, kTable).err, "2 steps, 0 of them done before"));
}

TEST_CASE("cli: evaluate names the result whose numbers are damaged") {
    const TemporaryFolder folder;
    writeData(folder);
    REQUIRE_EQ(runRelume(folder, kTable).exitCode, 0);
    const std::string name = "out/steps/table-1-bunny-k1.json";
    auto result = nlohmann::ordered_json::parse(contents(folder.path() / name));
    result["numbers"] = nlohmann::ordered_json::object();
    result.erase("numbers_hash"); // as earlier versions stored it
    folder.write(name, result.dump());
    const Outcome damaged = runRelume(folder, kTable);
    CHECK_EQ(damaged.exitCode, 1);
    CHECK(says(damaged.err, name));
    const std::string report = contents(folder.path() / "out" / "report.html");
    CHECK(says(report, name + ", and the same command makes it anew"));
    CHECK_FALSE(says(report, "table-1-bunny-k4.json"));
    std::filesystem::remove(folder.path() / name);
    const Outcome again = runRelume(folder, kTable);
    CHECK_EQ(again.exitCode, 0);
    CHECK(says(again.err, "2 steps, 1 of them done before"));
}

TEST_CASE("cli: evaluate tells what is missing of the sections that are asked for or have results") {
    const TemporaryFolder folder;
    writeData(folder);
    const Outcome alone = runRelume(folder, kTable);
    REQUIRE_EQ(alone.exitCode, 0);
    CHECK(says(alone.err, "lucy*"));
    CHECK_FALSE(says(alone.err, "uffizi*"));
    CHECK_FALSE(says(contents(folder.path() / "out" / "report.html"), "uffizi*"));
    folder.write("out/steps/scenes-dragon-reference.json", "{}");
    CHECK(says(runRelume(folder, kTable).err, "uffizi*"));
}

TEST_CASE("cli: evaluate that is stopped exits with 130 and goes on") {
    const TemporaryFolder folder;
    writeData(folder);
    const pid_t process = startRelume(folder, "evaluate --quick --data data --only table-1 figure-3 -o out");
    const auto firstResult = folder.path() / "out" / "steps" / "table-1-bunny-k1.json";
    int status = 0;
    while (!std::filesystem::exists(firstResult) && waitpid(process, &status, WNOHANG) == 0) usleep(2000);
    kill(process, SIGINT);
    REQUIRE_EQ(waitpid(process, &status, 0), process);
    REQUIRE(WIFEXITED(status));
    CHECK_EQ(WEXITSTATUS(status), 130);
    CHECK(says(contents(folder.path() / "err.txt"), "the same command goes on"));
    const Outcome rest = runRelume(folder, kTable);
    CHECK_EQ(rest.exitCode, 0);
    CHECK(says(rest.err, "2 steps, 1 of them done before"));
}

TEST_CASE("cli: evaluate refuses what it does not know") {
    const TemporaryFolder folder;
    const Outcome section = runRelume(folder, "evaluate --only tabel-1 -o out");
    CHECK_EQ(section.exitCode, 2);
    CHECK(says(section.err, "table-1"));
    const Outcome several = runRelume(folder, "evaluate --only table-1,tabel-2 -o out");
    CHECK_EQ(several.exitCode, 2);
    CHECK(says(several.err, "\"table-2\""));
    CHECK_EQ(runRelume(folder, "evaluate --quick -o ''").exitCode, 2);
    const Outcome data = runRelume(folder, "evaluate --data nowhere -o out");
    CHECK_EQ(data.exitCode, 2);
    CHECK(says(data.err, "nowhere"));
    CHECK_EQ(runRelume(folder, "evaluate --quick").exitCode, 2);
    CHECK_FALSE(std::filesystem::exists(folder.path() / "out"));
    folder.write("file", "");
    CHECK_EQ(
        runRelume(folder, kTable.substr(0, kTable.find("--data")) + "--only table-1 -o file/out").exitCode,
        1);
}
