// Tests that outputs which would overwrite an input are found, whatever their name.
#include "apps/relume/command_files.h"

#include "engine/base/error.h"
#include "tests/support/capture_binding.h"
#include "tests/support/temporary_folder.h"

#include <doctest/doctest.h>

using namespace relume;
using namespace relume::test;

namespace {

// A file, a link to it, and a link to their folder.
struct LinkedFolder : TemporaryFolder {
    LinkedFolder() {
        write("in.txt", "precious");
        std::filesystem::create_directory(path() / "sub");
        std::filesystem::create_symlink("in.txt", path() / "link.txt");
        std::filesystem::create_symlink(path(), path() / "here");
    }
};

bool isRefused(const CommandFiles& files, const std::string& option) {
    try {
        files.check();
    } catch (const UsageError& refused) {
        CHECK(std::string(refused.what()).starts_with(option));
        return true;
    }
    return false;
}

} // namespace

TEST_CASE("command files: an output that is an input is refused, by whatever name") {
    const LinkedFolder folder;
    for (const char* name :
         {"in.txt", "./in.txt", "sub/../in.txt", "link.txt", "here/in.txt", "here/link.txt"})
        for (const char* input : {"in.txt", "link.txt"}) {
            CAPTURE(name);
            CommandFiles files;
            files.addOutput("--output", folder.path() / name);
            CHECK_FALSE(isRefused(files, "--output"));
            files.addInput(folder.path() / input);
            CHECK(isRefused(files, "--output"));
        }
    CommandFiles others;
    others.addInputs({folder.path() / "in.txt", "built-in", ""});
    others.addOutput("--output", folder.path() / "other.txt");
    others.addOutput("--timings", "");
    CHECK_FALSE(isRefused(others, ""));
}

TEST_CASE("command files: what was read by then is an input") {
    const LinkedFolder folder;
    readFile(folder.path() / "in.txt"); // by no command
    CommandFiles files;
    files.addOutput("--timings", folder.path() / "here/in.txt");
    CHECK_FALSE(isRefused(files, "--timings"));
    readFile(folder.path() / "link.txt");
    CHECK(isRefused(files, "--timings"));
}

TEST_CASE("command files: two outputs that are one file are refused, there or not") {
    const LinkedFolder folder;
    for (const auto& [first, second] : {std::pair("new.txt", "new.txt"),
                                        {"new.txt", "here/sub/../new.txt"},
                                        {"link.txt", "in.txt"},
                                        {"sub/new.txt", "here/sub/new.txt"}}) {
        CAPTURE_BINDING(second);
        CommandFiles files;
        files.addOutput("--output", folder.path() / first);
        CHECK_FALSE(isRefused(files, "--output"));
        files.addOutput("--timings", folder.path() / second);
        CHECK(isRefused(files, "--timings"));
    }
    CommandFiles relative;
    relative.addOutput("--output", "not-there.txt");
    relative.addOutput("--timings", std::filesystem::current_path() / "not-there.txt");
    CHECK(isRefused(relative, "--timings"));
}

TEST_CASE("command files: an output may replace the input that it is said to") {
    const LinkedFolder folder;
    CommandFiles files;
    files.addInput(folder.path() / "in.txt");
    files.addOutput("--output", folder.path() / "in.txt", folder.path() / "link.txt");
    CHECK_FALSE(isRefused(files, ""));
    files.addOutput("--timings", folder.path() / "in.txt");
    CHECK(isRefused(files, "--timings"));
}
