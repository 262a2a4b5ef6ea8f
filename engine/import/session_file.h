// Reading of the viewer's session files: docs/session_format.md.
#pragma once

#include <array>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace relume {

// All keys that a session can have.
constexpr std::array<std::string_view, 22> kSessionKeys = {
    "session", "bake",       "model",           "size",        "eye",      "target",
    "fov",     "rotate",     "coefficients",    "threshold",   "light",    "environment",
    "time",    "material",   "samples",         "terms",       "residual", "exposure",
    "tone",    "background", "background-blur", "ground-style"};

// Returns the content of a session file: only keys of sessions, of the right types, none that excludes
// another, with file names as absolute paths. Values may be out of range. Errors name file and key.
nlohmann::json readSessionFile(const std::filesystem::path& path);

} // namespace relume
