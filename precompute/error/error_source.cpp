#include "precompute/error/error_source.h"

namespace relume {

namespace {

struct Words {
    std::string_view title, name;
};
constexpr std::array<Words, kErrorSources> kWords = {{
    {"drawing (lit spheres)", "drawing"},
    {"light selection", "light_selection"},
    {"storage", "storage"},
    {"wavelet truncation (N)", "truncation"},
    {"vertex interpolation", "interpolation"},
    {"BRDF terms (K)", "terms"},
    {"map resolution (S)", "map_resolution"},
    {"transport evaluation", "evaluation"},
    {"light resolution (F)", "light_resolution"},
    {"occluder", "occluder"},
    {"visibility resolution (V)", "visibility"},
    {"bounced light", "bounces"},
    {"bounces beyond the bake's", "more_bounces"},
}};

} // namespace

std::string_view errorSourceTitle(ErrorSource source) { return kWords[size_t(source)].title; }
std::string_view errorSourceName(ErrorSource source) { return kWords[size_t(source)].name; }

} // namespace relume
