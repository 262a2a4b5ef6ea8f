#include "engine/base/error.h"

#include <doctest/doctest.h>

using namespace relume;
using namespace std::string_literals;

TEST_CASE("error: control characters neither end its text nor reach a terminal") {
    const std::string hostile = "a.obj: found \"\0\x1b[31m\t\x7f\xc2\x9b"s + "1m\": export it\nagain, Müller";
    const std::string shown = "a.obj: found \"\\x00\\x1b[31m\\x09\\x7f\\x9b1m\": export it\nagain, Müller";
    CHECK(std::string(Error(hostile).what()) == shown);
    CHECK(std::string(UsageError(hostile).what()) == shown);
    CHECK(printable(shown) == shown);
}
