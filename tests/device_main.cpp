// The main function of tests on a Vulkan device: messages of validation appear on stderr.
#define DOCTEST_CONFIG_IMPLEMENT
#include "engine/base/log.h"

#include <cstdio>
#include <doctest/doctest.h>

int main(int argc, char** argv) {
    relume::setLog([](relume::LogLevel, const std::string& text) {
        if (text.starts_with("validation: ")) std::fprintf(stderr, "%s\n", text.c_str());
    });
    return doctest::Context(argc, argv).run();
}
