#include "engine/math/disk_map.h"

#include <algorithm>
#include <cmath>

namespace relume {

vec2 diskMapCoordinates(DiskMapping mapping, vec3 local) {
    switch (mapping) {
    case DiskMapping::Orthographic:
        return {0.5f * local.x + 0.5f, 0.5f * local.y + 0.5f};
    case DiskMapping::EqualAreaPolar:
        return {std::atan2(local.y, local.x) / (2.0f * kPi) + 0.5f,
                std::sqrt(std::max(0.0f, 1.0f - local.z))};
    case DiskMapping::Polar:
        return {std::atan2(local.y, local.x) / (2.0f * kPi) + 0.5f,
                std::min(1.0f, std::sqrt(local.x * local.x + local.y * local.y))};
    case DiskMapping::EqualArea:
        break;
    }
    const float scale = 0.5f / std::sqrt(1.0f + std::max(local.z, 0.0f));
    return {scale * local.x + 0.5f, scale * local.y + 0.5f};
}

std::optional<vec3> diskMapDirection(DiskMapping mapping, vec2 coordinates) {
    if (isPolar(mapping)) {
        const float angle = (coordinates.x - 0.5f) * 2.0f * kPi, y = coordinates.y;
        const bool isSine = mapping == DiskMapping::Polar;
        const float z = isSine ? std::sqrt(std::max(0.0f, 1.0f - y * y)) : 1.0f - y * y;
        const float radius = isSine ? y : std::sqrt(std::max(0.0f, 1.0f - z * z));
        return vec3(radius * std::cos(angle), radius * std::sin(angle), z);
    }
    const vec2 disk = 2.0f * coordinates - 1.0f;
    const float squared = glm::dot(disk, disk);
    if (squared >= 1.0f) return std::nullopt;
    if (mapping == DiskMapping::Orthographic) return vec3(disk, std::sqrt(1.0f - squared));
    return vec3(disk * std::sqrt(2.0f - squared), 1.0f - squared);
}

float diskMapSolidAngle(DiskMapping mapping, vec2 coordinates) {
    if (mapping == DiskMapping::EqualAreaPolar) return 4.0f * kPi * coordinates.y;
    if (mapping == DiskMapping::Polar)
        return 2.0f * kPi * coordinates.y / std::sqrt(1.0f - coordinates.y * coordinates.y);
    if (mapping == DiskMapping::EqualArea) return 8.0f;
    const vec2 disk = 2.0f * coordinates - 1.0f;
    return 4.0f / std::sqrt(1.0f - glm::dot(disk, disk));
}

vec3 liftAboveHorizon(vec3 local) {
    return glm::normalize(vec3(local.x, local.y, std::max(local.z, kGrazingCosine)));
}

std::string_view diskMappingName(DiskMapping mapping) {
    switch (mapping) {
    case DiskMapping::Orthographic:
        return "orthographic";
    case DiskMapping::EqualAreaPolar:
        return "polar";
    case DiskMapping::Polar:
        return "polar-sine";
    case DiskMapping::EqualArea:
        break;
    }
    return "equal-area";
}

std::optional<DiskMapping> diskMappingFromName(std::string_view name) {
    for (DiskMapping mapping :
         {DiskMapping::Orthographic, DiskMapping::EqualAreaPolar, DiskMapping::EqualArea, DiskMapping::Polar})
        if (name == diskMappingName(mapping)) return mapping;
    return std::nullopt;
}

} // namespace relume
