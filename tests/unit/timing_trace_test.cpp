#include "engine/base/error.h"
#include "engine/import/timing_file.h"
#include "tests/support/temporary_folder.h"

#include <doctest/doctest.h>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace relume;

namespace {

TimingTrace makeTrace() {
    using enum TimingSpan::Track;
    return {"a \"device\"",
            "driver \xff 1",
            ClockMatch::Anchored,
            12'345,
            {{Cpu, {}, "load", 0, 2'000'001},
             {Cpu, 0, "frame", 2'000'002, 5'000'000},
             {Cpu, 0, "a, \"b\"", 2'000'003, 1},
             {Gpu, 0, "view", 123'456'789'012'345, 999}}};
}

} // namespace

TEST_CASE("timing trace: trace events name their tracks and keep every nanosecond") {
    const auto json = nlohmann::json::parse(chromeTrace(makeTrace()));
    CHECK_EQ(json["otherData"]["device"], "a \"device\"");
    CHECK_EQ(json["otherData"]["driver"], "driver \ufffd 1");
    CHECK_EQ(json["otherData"]["clock"], "anchored");
    CHECK_EQ(json["otherData"]["clock_uncertainty_us"], 12.345);
    std::map<int, std::string> tracks;
    std::vector<nlohmann::json> spans;
    for (const auto& event : json["traceEvents"]) {
        if (event["ph"] == "X") spans.push_back(event);
        if (event["name"] == "thread_name") tracks[event["tid"]] = event["args"]["name"];
    }
    CHECK_EQ(tracks, std::map<int, std::string>{{1, "CPU"}, {2, "GPU"}});
    REQUIRE_EQ(spans.size(), 4u);
    CHECK_FALSE(spans[0].contains("args"));
    CHECK_EQ(spans[0]["dur"], 2000.001);
    CHECK_EQ(spans[1]["args"]["frame"], 0);
    CHECK_EQ(spans[1]["ts"], 2000.002);
    CHECK_EQ(spans[2]["name"], "a, \"b\"");
    CHECK_EQ(spans[3]["tid"], 2);
    CHECK_EQ(spans[3]["ts"], 123'456'789'012.345);
    CHECK_EQ(spans[3]["dur"], 0.999);
}

TEST_CASE("timing trace: without a GPU clock there is no GPU track") {
    TimingTrace trace = makeTrace();
    trace.clock = ClockMatch::None;
    trace.spans.pop_back();
    const auto json = nlohmann::json::parse(chromeTrace(trace));
    CHECK_EQ(json["otherData"]["clock"], "none");
    CHECK_FALSE(json["otherData"].contains("clock_uncertainty_us"));
    for (const auto& event : json["traceEvents"])
        if (event.contains("tid")) CHECK_EQ(event["tid"], 1);
}

TEST_CASE("timing trace: the table has a row a span") {
    CHECK_EQ(csvTable(makeTrace()), "frame,track,name,start_us,duration_us\n"
                                    ",CPU,load,0.000,2000.001\n"
                                    "0,CPU,frame,2000.002,5000.000\n"
                                    "0,CPU,\"a, \"\"b\"\"\",2000.003,0.001\n"
                                    "0,GPU,view,123456789012.345,0.999\n");
}

TEST_CASE("timing trace: the extension decides the form, and must be one of two") {
    const test::TemporaryFolder folder;
    for (const char* name : {"a.txt", "a", "a.JSON", ".json"})
        CHECK_THROWS_AS(expectTimingFile(folder.path() / name), UsageError);
    CHECK_THROWS_AS(expectTimingFile(folder.path() / "nowhere" / "a.csv"), Error);
    for (const auto& [name, text] :
         {std::pair{"a.json", chromeTrace(makeTrace())}, {"a.csv", csvTable(makeTrace())}}) {
        expectTimingFile(folder.path() / name);
        CHECK_FALSE(std::filesystem::exists(folder.path() / name));
        writeTimings(folder.path() / name, makeTrace());
        std::stringstream found;
        found << std::ifstream(folder.path() / name).rdbuf();
        CHECK_EQ(found.str(), text);
    }
}
