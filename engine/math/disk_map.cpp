#include "engine/math/disk_map.h"

#include <algorithm>
#include <cmath>

namespace relume {

vec2 diskMapCoordinates(DiskMapping mapping, vec3 local) {
    if (mapping == DiskMapping::Orthographic) return {0.5f * local.x + 0.5f, 0.5f * local.y + 0.5f};
    return {std::atan2(local.y, local.x) / (2.0f * kPi) + 0.5f, std::sqrt(std::max(0.0f, 1.0f - local.z))};
}

std::optional<vec3> diskMapDirection(DiskMapping mapping, vec2 coordinates) {
    if (mapping == DiskMapping::Orthographic) {
        const vec2 disk = 2.0f * coordinates - 1.0f;
        const float squared = glm::dot(disk, disk);
        if (squared >= 1.0f) return std::nullopt;
        return vec3(disk, std::sqrt(1.0f - squared));
    }
    const float angle = (coordinates.x - 0.5f) * 2.0f * kPi;
    const float z = 1.0f - coordinates.y * coordinates.y;
    const float radius = std::sqrt(std::max(0.0f, 1.0f - z * z));
    return vec3(radius * std::cos(angle), radius * std::sin(angle), z);
}

vec3 liftAboveHorizon(vec3 local) {
    return glm::normalize(vec3(local.x, local.y, std::max(local.z, kGrazingCosine)));
}

std::string_view diskMappingName(DiskMapping mapping) {
    return mapping == DiskMapping::Orthographic ? "orthographic" : "polar";
}

std::optional<DiskMapping> diskMappingFromName(std::string_view name) {
    for (DiskMapping mapping : {DiskMapping::Orthographic, DiskMapping::Polar})
        if (name == diskMappingName(mapping)) return mapping;
    return std::nullopt;
}

} // namespace relume
