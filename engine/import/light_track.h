// Values of light files that change over time.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace relume {

// A track stands where a number or [r, g, b] may: {"keys": [[seconds, value], …], "repeat": false}. Between
// two keys values change evenly; before the first and after the last they stay, unless they repeat from 0 to
// the last key's time. At most kMostTrackKeys, at rising times from 0.
constexpr size_t kMostTrackKeys = 4096;

// The most keys that a track in `json` has; 0 without tracks. Throws Error, beginning with `place`, for
// tracks that are none.
size_t mostTrackKeys(const nlohmann::json& json, const std::string& place);

// `json` with its tracks, checked before, replaced by their values at a time of at least 0 (those of "rate"
// and "hours_per_second", which are multiplied by the time, by their means until then), or by that of key
// number `key`, or the last.
nlohmann::json withTracksAt(const nlohmann::json& json, double seconds);
nlohmann::json withTrackKey(const nlohmann::json& json, size_t key);

} // namespace relume
