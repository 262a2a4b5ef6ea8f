// Files that appear whole or not at all.
#include "engine/base/file.h"
#include "tests/support/temporary_folder.h"

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <thread>

using namespace relume;

TEST_CASE("atomic file: threads write files that have the permissions of any new one, and leave the umask") {
    const test::TemporaryFolder folder;
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
