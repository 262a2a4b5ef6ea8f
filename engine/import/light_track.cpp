#include "engine/import/light_track.h"

#include "engine/base/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

using Json = nlohmann::json;

constexpr int kDepth = 5; // nesting depth of values in light files

bool isTrack(const Json& json) { return json.is_object() && json.contains("keys"); }

// Calls visit(track, place) for every track.
template <typename Visit>
void forEachTrack(const Json& json, const std::string& place, const Visit& visit, int depth = 0) {
    if (depth == kDepth) return;
    if (isTrack(json)) return visit(json, place);
    if (json.is_object()) {
        for (const auto& [key, value] : json.items())
            forEachTrack(value, fmt::format("{}: {}", place, key), visit, depth + 1);
    } else if (json.is_array()) {
        for (size_t i = 0; i < json.size(); i++)
            forEachTrack(json[i], fmt::format("{}[{}]", place, i), visit, depth + 1);
    }
}

// Returns a copy of `json` in which valueOf(track, key) replaces each track; `key` is that of the object
// which the track is in. Does not copy keys, of which there may be very many.
template <typename ValueOf>
Json withTracks(const Json& json, const ValueOf& valueOf, const std::string& key = "", int depth = 0) {
    if (depth == kDepth) return json;
    if (isTrack(json)) return valueOf(json, key);
    if (json.is_object()) {
        Json result = Json::object();
        for (const auto& [name, value] : json.items())
            result[name] = withTracks(value, valueOf, name, depth + 1);
        return result;
    }
    if (!json.is_array()) return json;
    Json result = Json::array();
    for (const Json& value : json) result.push_back(withTracks(value, valueOf, key, depth + 1));
    return result;
}

bool isColor(const Json& value) {
    return value.is_array() && value.size() == 3 &&
           std::ranges::all_of(value, [](const Json& number) { return number.is_number(); });
}

void checkTrack(const Json& track, const std::string& place) {
    const auto fail = [&](const std::string& what) {
        throw Error(fmt::format("{}: a track {}", place, what));
    };
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

const Json::array_t& keysOf(const Json& track) { return track["keys"].get_ref<const Json::array_t&>(); }

double timeOf(const Json& key) { return key[0].get<double>(); }

// Returns the track's last time if it repeats, else 0.
double periodOf(const Json& track) { return track.value("repeat", false) ? timeOf(keysOf(track).back()) : 0; }

Json valueAt(const Json& track, double seconds) {
    const Json::array_t& keys = keysOf(track);
    if (const double period = periodOf(track); period > 0) seconds = std::fmod(seconds, period);
    const auto after = std::ranges::upper_bound(keys, seconds, {}, timeOf);
    if (after == keys.begin()) return (*after)[1];
    const Json& from = *std::prev(after);
    if (after == keys.end()) return from[1];
    const double start = timeOf(from);
    return mixed(from[1], (*after)[1], (seconds - start) / (timeOf(*after) - start));
}

// Returns the integral of a track of numbers from 0 to `end`, without repetition.
double integralTo(const Json::array_t& keys, double end) {
    double sum = 0, time = 0, value = keys.front()[1].get<double>();
    for (const Json& key : keys) {
        const double next = timeOf(key), target = key[1].get<double>();
        if (next >= end && next > time) {
            const double last = value + (target - value) * (end - time) / (next - time);
            return sum + (value + last) / 2 * (end - time);
        }
        sum += (value + target) / 2 * (next - time);
        time = next;
        value = target;
    }
    return sum + value * (end - time);
}

// Returns the mean of a track of numbers from 0 to `seconds`.
double meanTo(const Json& track, double seconds) {
    if (seconds == 0) return valueAt(track, 0).get<double>();
    const Json::array_t& keys = keysOf(track);
    const double period = periodOf(track);
    if (!(period > 0)) return integralTo(keys, seconds) / seconds;
    const double rounds = std::floor(seconds / period);
    return (rounds * integralTo(keys, period) + integralTo(keys, seconds - rounds * period)) / seconds;
}

// Returns whether the value is a rate, which is multiplied by the time. Its mean up to a time then gives the
// integral of all its values so far.
bool isSpeed(const std::string& key) { return key == "rate" || key == "hours_per_second"; }

} // namespace

size_t mostTrackKeys(const Json& json, const std::string& place) {
    size_t most = 0;
    forEachTrack(json, place, [&](const Json& track, const std::string& where) {
        checkTrack(track, where);
        most = std::max(most, track["keys"].size());
    });
    return most;
}

Json withTracksAt(const Json& json, double seconds) {
    return withTracks(json, [&](const Json& track, const std::string& key) {
        return isSpeed(key) ? Json(meanTo(track, seconds)) : valueAt(track, seconds);
    });
}

Json withTrackKey(const Json& json, size_t key) {
    return withTracks(json, [&](const Json& track, const std::string&) {
        const Json::array_t& keys = keysOf(track);
        return keys[std::min(key, keys.size() - 1)][1];
    });
}

} // namespace relume
