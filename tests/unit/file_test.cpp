// Tests reading of files, and files that appear whole or not at all.
#include "engine/base/file.h"
#include "tests/support/failure.h"
#include "tests/support/temporary_folder.h"

#include <array>
#include <doctest/doctest.h>
#include <sys/stat.h>
#include <thread>

using namespace relume;
using namespace relume::test;

TEST_CASE("files: nothing but regular files is read, and those up to a limit") {
    const TemporaryFolder folder;
    const auto file = folder.write("five", "12345");
    CHECK(readFile(file, 5).size() == 5);
    CHECK(says(failureOf([&] { readFile(file, 4); }), "holds 5 bytes, more than the 4"));
    const auto pipe = folder.path() / "pipe";
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    for (const std::filesystem::path& path : {folder.path(), pipe}) {
        CHECK(says(failureOf([&] { readFile(path); }), "expected a regular file"));
        CHECK(says(failureOf([&] { FileReader reader(path); }), "expected a regular file"));
    }
    FileReader reader(file);
    std::filesystem::resize_file(file, 3);
    std::array<std::byte, 5> bytes;
    CHECK(says(failureOf([&] { reader.read(0, bytes); }), "became shorter"));
}

TEST_CASE("atomic file: threads write files that have the permissions of any new one, and leave the umask") {
    const TemporaryFolder folder;
    const mode_t before = umask(027);
    {
        std::vector<std::jthread> threads;
        for (int thread = 0; thread < 8; thread++)
            threads.emplace_back([&, thread] {
                for (int i = 0; i < 20; i++)
                    writeFileAtomically(folder.path() / std::to_string(20 * thread + i), std::string("text"));
            });
    }
    CHECK_EQ(umask(before), 027);
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        struct stat status {};
        REQUIRE_EQ(stat(entry.path().c_str(), &status), 0);
        CHECK_EQ(status.st_mode & 0777, 0640);
        files++;
    }
    CHECK_EQ(files, 160); // and nothing else is left
}
