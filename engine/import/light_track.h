// Tracks: values of light files that change over time.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace relume {

// A track takes the place of a number or [r, g, b]: {"keys": [[seconds, value], …], "repeat": false}. Values
// are interpolated linearly between keys; before the first and after the last key they are constant, unless
// they repeat from 0 to the last key's time. There are at most kMostTrackKeys keys, at rising times from 0.
constexpr size_t kMostTrackKeys = 4096;

// Returns the number of keys of the longest track in `json`; 0 without tracks. Throws Error, beginning with
// `place`, if a track is invalid.
size_t mostTrackKeys(const nlohmann::json& json, const std::string& place);

// Return `json` with each track, checked before, replaced by its value: at a time of at least 0, or at key
// number `key` (the last if there are fewer). By time, "rate" and "hours_per_second", which are multiplied by
// the time, become their means from 0 until then.
nlohmann::json withTracksAt(const nlohmann::json& json, double seconds);
nlohmann::json withTrackKey(const nlohmann::json& json, size_t key);

} // namespace relume
