#include "engine/light/light_track.h"

#include "engine/base/error.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

using Json = nlohmann::json;

constexpr int kDepth = 5; // of values in light files

// Calls visit(track, place) for all tracks.
template <typename Value, typename Visit>
void forEachTrack(Value& json, const std::string& place, const Visit& visit, int depth = 0) {
    if (depth == kDepth) return;
    if (json.is_object()) {
        if (json.contains("keys")) return visit(json, place);
        for (auto& [key, value] : json.items())
            forEachTrack(value, fmt::format("{}: {}", place, key), visit, depth + 1);
    } else if (json.is_array()) {
        for (size_t i = 0; i < json.size(); i++)
            forEachTrack(json[i], fmt::format("{}[{}]", place, i), visit, depth + 1);
    }
}

bool isColor(const Json& value) {
    return value.is_array() && value.size() == 3 &&
           std::ranges::all_of(value, [](const Json& number) { return number.is_number(); });
}

void checkTrack(const Json& track, const std::string& place) {
    const auto fail = [&](const std::string& what) { throw Error("{}: a track {}", place, what); };
    for (const auto& [key, value] : track.items())
        if (key != "keys" && key != "repeat")
            fail(fmt::format("has \"keys\" and \"repeat\", found \"{}\"", key));
    if (track.contains("repeat") && !track["repeat"].is_boolean()) fail("repeats by true or false");
    const Json& keys = track["keys"];
    if (!keys.is_array() || keys.empty() || keys.size() > kMostTrackKeys)
        fail(fmt::format("has 1 to {} keys", kMostTrackKeys));
    double before = -1;
    for (const Json& key : keys) {
        if (!key.is_array() || key.size() != 2 || !key[0].is_number() ||
            !(key[1].is_number() || isColor(key[1])) || isColor(key[1]) != isColor(keys[0][1]))
            fail(fmt::format("has keys [seconds, value], all of numbers or all of [r, g, b]; found {}",
                             key.dump().substr(0, 60)));
        const auto time = key[0].get<double>();
        if (!(time > before) || time < 0 || !std::isfinite(time))
            fail(fmt::format("has keys at rising times from 0, found {} after {}", time, before));
        before = time;
    }
}

Json mixed(const Json& a, const Json& b, double weight) {
    if (a.is_number()) return a.get<double>() + weight * (b.get<double>() - a.get<double>());
    Json color = Json::array();
    for (size_t i = 0; i < a.size(); i++) color.push_back(mixed(a[i], b[i], weight));
    return color;
}

Json valueAt(const Json& track, double seconds) {
    const Json& keys = track["keys"];
    const auto end = keys.back()[0].get<double>();
    if (track.value("repeat", false) && end > 0) seconds = std::fmod(seconds, end);
    const auto after =
        std::ranges::find_if(keys, [&](const Json& key) { return key[0].template get<double>() > seconds; });
    if (after == keys.begin()) return (*after)[1];
    const Json& from = *std::prev(after);
    if (after == keys.end()) return from[1];
    const auto start = from[0].get<double>();
    return mixed(from[1], (*after)[1], (seconds - start) / ((*after)[0].get<double>() - start));
}

} // namespace

size_t mostTrackKeys(const Json& json, const std::string& place) {
    size_t most = 0;
    forEachTrack(json, place, [&](const Json& track, const std::string& where) {
        checkTrack(track, where);
        most = std::max(most, track["keys"].size());
    });
    return most;
}

Json withTracksAt(Json json, double seconds) {
    forEachTrack(json, "", [&](Json& track, const std::string&) { track = valueAt(track, seconds); });
    return json;
}

Json withTrackKey(Json json, size_t key) {
    forEachTrack(json, "", [&](Json& track, const std::string&) {
        const Json& keys = track["keys"];
        track = Json(keys[std::min(key, keys.size() - 1)][1]);
    });
    return json;
}

} // namespace relume
