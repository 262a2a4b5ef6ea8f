#include "engine/import/timing_file.h"

#include "engine/base/error.h"
#include "engine/base/file.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <utility>

namespace relume {

namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr int kProcess = 1;

int threadOf(TimingSpan::Track track) { return track == TimingSpan::Track::Cpu ? 1 : 2; }
const char* nameOf(TimingSpan::Track track) { return track == TimingSpan::Track::Cpu ? "CPU" : "GPU"; }

OrderedJson metadata(const char* what, std::optional<TimingSpan::Track> track, OrderedJson arguments) {
    OrderedJson event = {{"ph", "M"}, {"pid", kProcess}};
    if (track) event["tid"] = threadOf(*track);
    event["name"] = what;
    event["args"] = std::move(arguments);
    return event;
}

OrderedJson eventOf(const TimingSpan& span) {
    OrderedJson event = {{"ph", "X"},
                         {"pid", kProcess},
                         {"tid", threadOf(span.track)},
                         {"ts", double(span.start) / 1000},
                         {"dur", double(span.duration) / 1000},
                         {"name", span.name}};
    if (span.frame) event["args"] = {{"frame", *span.frame}};
    return event;
}

// Returns a CSV field, quoted if necessary.
std::string csvField(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

} // namespace

const char* nameOf(ClockMatch clock) {
    switch (clock) {
    case ClockMatch::Calibrated:
        return "calibrated";
    case ClockMatch::Anchored:
        return "anchored";
    default:
        return "none";
    }
}

std::string chromeTrace(const TimingTrace& trace) {
    OrderedJson about = {{"device", trace.device}, {"driver", trace.driver}, {"clock", nameOf(trace.clock)}};
    if (trace.clock != ClockMatch::None)
        about["clock_uncertainty_us"] = double(trace.clockUncertainty) / 1000;
    std::vector<OrderedJson> tracks = {metadata("process_name", {}, {{"name", "relume"}})};
    for (const TimingSpan::Track track : {TimingSpan::Track::Cpu, TimingSpan::Track::Gpu}) {
        if (track == TimingSpan::Track::Gpu && trace.clock == ClockMatch::None) continue;
        tracks.push_back(metadata("thread_name", track, {{"name", nameOf(track)}}));
        tracks.push_back(metadata("thread_sort_index", track, {{"sort_index", threadOf(track)}}));
    }
    // Write events one by one, one per line; as one JSON document all of them would take many times their
    // size in memory. Device and driver names come from the driver, so bytes that are not UTF-8 are replaced.
    const auto dump = [](const OrderedJson& json) {
        return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
    };
    std::string text = "{\"displayTimeUnit\":\"ms\",\"otherData\":" + dump(about) + ",\n\"traceEvents\":[";
    const char* separator = "\n";
    for (const OrderedJson& event : tracks) text += std::exchange(separator, ",\n") + dump(event);
    for (const TimingSpan& span : trace.spans) text += separator + dump(eventOf(span));
    return text + "\n]}\n";
}

std::string csvTable(const TimingTrace& trace) {
    std::string text = "frame,track,name,start_us,duration_us\n";
    for (const TimingSpan& span : trace.spans)
        text += fmt::format("{},{},{},{:.3f},{:.3f}\n", span.frame ? std::to_string(*span.frame) : "",
                            nameOf(span.track), csvField(span.name), double(span.start) / 1000,
                            double(span.duration) / 1000);
    return text;
}

void expectTimingFile(const std::filesystem::path& path) {
    if (path.extension() != ".json" && path.extension() != ".csv")
        throw UsageError(
            fmt::format("--timings: expected a name ending in .json (for trace viewers) or .csv (a table), "
                        "found \"{}\"",
                        path.string()));
    expectWritable(path);
}

void writeTimings(const std::filesystem::path& path, const TimingTrace& trace) {
    writeFileAtomically(path, path.extension() == ".json" ? chromeTrace(trace) : csvTable(trace));
}

} // namespace relume
