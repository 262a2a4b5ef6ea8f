// Shaders built anew while the window is open.
#include "tests/support/viewer_session.h"

#include <fmt/core.h>

using namespace relume;
using namespace relume::test;
using nlohmann::json;

namespace {

void replace(const std::filesystem::path& file, const std::string& from, const std::string& to) {
    std::string text = contents(file);
    const size_t place = text.find(from);
    REQUIRE_NE(place, std::string::npos);
    std::ofstream(file) << text.replace(place, from.size(), to);
}

// A window before and after F5, with these sources.
Outcome reload(ViewerSession& session, const std::filesystem::path& shaders) {
    const Outcome outcome = session.replay({{{"set", {{"panels", false}}}},
                                            {{"wait", "settled"}},
                                            {{"screenshot", "before.png"}},
                                            {{"screenshot", "before.exr"}},
                                            {{"key", "F5"}},
                                            {{"wait", "settled"}},
                                            {{"screenshot", "after.png"}},
                                            {{"screenshot", "after.exr"}},
                                            {{"quit", true}}},
                                           "ring.relume", "RELUME_SHADERS='" + shaders.string() + "'");
    REQUIRE_MESSAGE(outcome.exitCode == 0, outcome.err);
    return outcome;
}

} // namespace

TEST_CASE("viewer: F5 builds shaders anew, and says what is wrong with them") {
    ViewerSession& session = sharedSession();
    const std::filesystem::path shaders = session.path("shaders"), display = shaders / "display.frag";
    std::filesystem::copy(RELUME_SHADERS, shaders, std::filesystem::copy_options::recursive);

    const Outcome same = reload(session, shaders);
    CAPTURE(same.err);
    CHECK(isQuiet(same.err));
    CHECK(says(same.err, "no shader has changed"));
    CHECK(session.bytes("before.png") == session.bytes("after.png"));

    const std::string whole = contents(display);
    const std::string statement = "display = vec4(";
    const auto line = 1 + std::count(whole.begin(), whole.begin() + ptrdiff_t(whole.find(statement)), '\n');
    replace(display, statement, "display = vec4(nothing + ");
    const Outcome broken = reload(session, shaders);
    CAPTURE(broken.err);
    CHECK(says(broken.err, fmt::format("{}:{}: ", display.string(), line)));
    CHECK(says(broken.err, "'nothing'"));
    CHECK_FALSE(says(broken.err, "validation:"));
    CHECK(session.bytes("before.png") == session.bytes("after.png"));

    std::ofstream(display) << whole;
    replace(display, statement, "display = vec4(1, 0, 0, 0) + vec4(");
    const Outcome changed = reload(session, shaders);
    CAPTURE(changed.err);
    CHECK(isQuiet(changed.err));
    CHECK(says(changed.err, "1 shaders are new"));
    CHECK(session.bytes("before.png") != session.bytes("after.png"));
    CHECK(session.bytes("before.exr") == session.bytes("after.exr")); // display is only shown

    std::ofstream(display) << whole;
    std::filesystem::remove(shaders / "view_shade.frag");
    const Outcome missing = reload(session, shaders);
    CHECK(says(missing.err, "view_shade.frag"));
    CHECK(session.bytes("before.png") == session.bytes("after.png"));

    const Outcome absent = reload(session, session.path("nowhere"));
    CHECK(says(absent.err, "nowhere: the shaders' sources are not there; RELUME_SHADERS names their folder"));
}
