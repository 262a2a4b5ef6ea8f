#include "engine/vk/features.h"

#include "engine/base/check.h"
#include "engine/vk/device.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <fmt/core.h>

namespace relume::vk {

namespace {

// Identifies a feature in Vulkan's structs: the struct's type and the member's offset.
struct Place {
    VkStructureType type;
    size_t offset;
};

#define IN(type, Struct, feature)                                                                            \
    Place {                                                                                                  \
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_##type##_FEATURES,                                                 \
            offsetof(VkPhysicalDevice##Struct##Features, feature)                                            \
    }
#define IN_CORE(feature)                                                                                     \
    Place {                                                                                                  \
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,                                                        \
            offsetof(VkPhysicalDeviceFeatures2, features) + offsetof(VkPhysicalDeviceFeatures, feature)      \
    }

struct Feature {
    std::string_view name;
    bool isNeeded;
    // In the struct of its Vulkan version, and in that of the extension before it if there is one.
    std::array<Place, 2> places;
};

const Feature kFeatures[] = {
    {"synchronization2",
     true,
     {IN(VULKAN_1_3, Vulkan13, synchronization2), IN(SYNCHRONIZATION_2, Synchronization2, synchronization2)}},
    {"dynamicRendering",
     true,
     {IN(VULKAN_1_3, Vulkan13, dynamicRendering), IN(DYNAMIC_RENDERING, DynamicRendering, dynamicRendering)}},
    {"maintenance4",
     true,
     {IN(VULKAN_1_3, Vulkan13, maintenance4), IN(MAINTENANCE_4, Maintenance4, maintenance4)}},
    {"subgroupSizeControl",
     true,
     {IN(VULKAN_1_3, Vulkan13, subgroupSizeControl),
      IN(SUBGROUP_SIZE_CONTROL, SubgroupSizeControl, subgroupSizeControl)}},
    {"computeFullSubgroups",
     true,
     {IN(VULKAN_1_3, Vulkan13, computeFullSubgroups),
      IN(SUBGROUP_SIZE_CONTROL, SubgroupSizeControl, computeFullSubgroups)}},
    {"scalarBlockLayout",
     true,
     {IN(VULKAN_1_2, Vulkan12, scalarBlockLayout),
      IN(SCALAR_BLOCK_LAYOUT, ScalarBlockLayout, scalarBlockLayout)}},
    {"multiDrawIndirect", true, {IN_CORE(multiDrawIndirect)}},
    {"drawIndirectFirstInstance", true, {IN_CORE(drawIndirectFirstInstance)}},
    {"shaderOutputLayer", false, {IN(VULKAN_1_2, Vulkan12, shaderOutputLayer)}},
    {"fullDrawIndexUint32", false, {IN_CORE(fullDrawIndexUint32)}},
};

VkBool32& at(void* start, size_t offset) {
    return *reinterpret_cast<VkBool32*>(static_cast<std::byte*>(start) + offset);
}

bool isOn(const VkDeviceCreateInfo& created, const Feature& feature) {
    if (created.pEnabledFeatures && feature.places[0].type == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2) {
        const size_t offset = feature.places[0].offset - offsetof(VkPhysicalDeviceFeatures2, features);
        return at(const_cast<VkPhysicalDeviceFeatures*>(created.pEnabledFeatures), offset) == VK_TRUE;
    }
    for (auto* next = static_cast<const VkBaseInStructure*>(created.pNext); next; next = next->pNext)
        for (const Place& place : feature.places)
            if (next->sType == place.type && at(const_cast<VkBaseInStructure*>(next), place.offset))
                return true;
    return false;
}

} // namespace

std::string missingFeature(const VkDeviceCreateInfo& created) {
    for (const Feature& feature : kFeatures)
        if (feature.isNeeded && !isOn(created, feature))
            return fmt::format("it was made without the feature {}", feature.name);
    return {};
}

bool hasFeature(const VkDeviceCreateInfo& created, std::string_view name) {
    const auto feature = std::ranges::find(kFeatures, name, &Feature::name);
    RELUME_CHECK(feature != std::end(kFeatures));
    return isOn(created, *feature);
}

Features::Features()
    : chain{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &vulkan12, {}},
      vulkan12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &vulkan13},
      vulkan13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES} {}

void enableFeatures(VkPhysicalDevice physical, Features& features) {
    Features offered;
    vkGetPhysicalDeviceFeatures2(physical, &offered.chain);
    const auto structOf = [](Features& of, VkStructureType type) -> void* {
        if (type == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES) return &of.vulkan13;
        if (type == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES) return &of.vulkan12;
        return &of.chain;
    };
    for (const Feature& feature : kFeatures) {
        const Place& place = feature.places[0];
        at(structOf(features, place.type), place.offset) =
            feature.isNeeded ? VK_TRUE : at(structOf(offered, place.type), place.offset);
    }
}

} // namespace relume::vk
