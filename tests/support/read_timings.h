// Timing files read back as strictly as a trace viewer would, and what must hold of their spans.
#pragma once

#include <cmath>
#include <doctest/doctest.h>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace relume::test {

struct ReadSpan {
    std::string track, name;
    std::optional<int> frame;
    double start, duration; // microseconds
    double end() const { return start + duration; }
};

// What decimals of microseconds may lose in a double.
constexpr double kTimingRounding = 1e-4;

inline std::vector<ReadSpan> readTraceEvents(const nlohmann::json& trace) {
    std::vector<ReadSpan> spans;
    std::map<int, std::string> tracks;
    REQUIRE(trace.at("traceEvents").is_array());
    for (const auto& event : trace.at("traceEvents")) {
        REQUIRE(event.at("name").is_string());
        REQUIRE(event.at("pid").is_number_integer());
        if (event.at("ph") == "M") {
            REQUIRE(event.at("args").is_object());
            if (event["name"] == "thread_name")
                tracks[event.at("tid").get<int>()] = event["args"].at("name").get<std::string>();
            continue;
        }
        REQUIRE_EQ(event.at("ph"), "X");
        const int thread = event.at("tid").get<int>();
        REQUIRE(tracks.contains(thread)); // named before it is used
        std::optional<int> frame;
        if (event.contains("args")) frame = event["args"].at("frame").get<int>();
        spans.push_back({tracks[thread], event["name"], frame, event.at("ts").get<double>(),
                         event.at("dur").get<double>()});
    }
    return spans;
}

inline std::vector<ReadSpan> readTimingTable(const std::string& text) {
    std::vector<ReadSpan> spans;
    std::stringstream lines(text);
    std::string line;
    REQUIRE(std::getline(lines, line));
    REQUIRE_EQ(line, "frame,track,name,start_us,duration_us");
    while (std::getline(lines, line)) {
        std::vector<std::string> fields;
        std::stringstream stream(line);
        for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
        REQUIRE_EQ(fields.size(), 5u);
        spans.push_back({fields[1], fields[2],
                         fields[0].empty() ? std::nullopt : std::optional(std::stoi(fields[0])),
                         std::stod(fields[3]), std::stod(fields[4])});
    }
    return spans;
}

// Spans of each track come in order of their starts, nest or are disjoint, and nest in their own frame's
// span.
inline void checkNesting(const std::vector<ReadSpan>& spans) {
    std::map<std::string, std::vector<ReadSpan>> open;
    std::map<std::string, double> last;
    for (const ReadSpan& span : spans) {
        CAPTURE(span.track);
        CAPTURE(span.name);
        CAPTURE(span.start);
        CHECK_GE(span.start, last[span.track]);
        CHECK_GE(span.duration, 0);
        last[span.track] = span.start;
        std::vector<ReadSpan>& outer = open[span.track];
        while (!outer.empty() && outer.back().end() <= span.start + kTimingRounding) outer.pop_back();
        if (!outer.empty()) CHECK_LE(span.end(), outer.back().end() + kTimingRounding);
        const bool inFrame = !outer.empty() && outer[0].name == "frame" && outer[0].frame == span.frame;
        CHECK_EQ(inFrame, span.frame && span.name != "frame");
        outer.push_back(span);
    }
}

// The one span of that track, frame and name.
inline ReadSpan onlySpan(const std::vector<ReadSpan>& spans, const std::string& track, int frame,
                         const std::string& name) {
    std::vector<ReadSpan> found;
    for (const ReadSpan& span : spans)
        if (span.track == track && span.frame == frame && span.name == name) found.push_back(span);
    CAPTURE(track);
    CAPTURE(frame);
    CAPTURE(name);
    REQUIRE_EQ(found.size(), 1u);
    return found[0];
}

// The GPU works on a frame after the CPU has begun to submit it, and is done before the CPU has waited for
// it, as far as the clocks are known to agree. A microsecond goes to a driver's idea of its own clock.
inline void checkClocksAgree(const std::vector<ReadSpan>& spans, int frames, double uncertainty) {
    for (int frame = 0; frame < frames; frame++) {
        const ReadSpan gpu = onlySpan(spans, "GPU", frame, "frame");
        const ReadSpan submit = onlySpan(spans, "CPU", frame, "submit");
        const ReadSpan wait = onlySpan(spans, "CPU", frame, "wait");
        CHECK_LE(submit.end(), wait.start + kTimingRounding);
        CHECK_GE(gpu.start, submit.start - uncertainty - 1);
        CHECK_LE(gpu.end(), wait.end() + uncertainty + 1);
    }
}

// GPU spans of a frame's passes fill at least 9/10 of the time from its first timestamp to its last: over all
// frames, and in the median one (any may have been interrupted between two passes on a busy machine).
inline void checkPassesFillFrames(const std::vector<ReadSpan>& spans, int frames) {
    double passes = 0, whole = 0;
    int filled = 0;
    for (int frame = 0; frame < frames; frame++) {
        double sum = 0;
        for (const ReadSpan& span : spans)
            if (span.track == "GPU" && span.frame == frame && span.name != "frame") sum += span.duration;
        const double time = onlySpan(spans, "GPU", frame, "frame").duration;
        CHECK_GT(sum, 0);
        CHECK_LE(sum, time + kTimingRounding * 100);
        filled += sum >= 0.9 * time;
        passes += sum;
        whole += time;
    }
    CHECK_GE(passes, 0.9 * whole);
    CHECK_GE(2 * filled, frames);
}

} // namespace relume::test
