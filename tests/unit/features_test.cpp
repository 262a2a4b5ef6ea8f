// Tests the check for features that a host's device must have enabled.
#include "engine/vk/features.h"

#include "engine/base/error.h"
#include "engine/vk/device.h"
#include "tests/support/capture_binding.h"

#include <doctest/doctest.h>

using namespace relume;
using vk::Features, vk::hasFeature, vk::missingFeature;

namespace {

// Turns on all that is needed, without asking a device what it offers.
void turnOn(Features& features) {
    features.chain.features.multiDrawIndirect = VK_TRUE;
    features.chain.features.drawIndirectFirstInstance = VK_TRUE;
    features.vulkan12.scalarBlockLayout = VK_TRUE;
    for (VkBool32* feature : {&features.vulkan13.synchronization2, &features.vulkan13.dynamicRendering,
                              &features.vulkan13.maintenance4, &features.vulkan13.subgroupSizeControl,
                              &features.vulkan13.computeFullSubgroups})
        *feature = VK_TRUE;
}

VkDeviceCreateInfo createdWith(const void* chain) {
    return {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, chain, 0, 0, nullptr, 0, nullptr, 0, nullptr, nullptr};
}

} // namespace

TEST_CASE("features: the one that is off is named") {
    Features features;
    turnOn(features);
    const VkDeviceCreateInfo created = createdWith(&features.chain);
    CHECK(missingFeature(created) == "");
    const std::pair<const char*, VkBool32*> needed[] = {
        {"synchronization2", &features.vulkan13.synchronization2},
        {"dynamicRendering", &features.vulkan13.dynamicRendering},
        {"maintenance4", &features.vulkan13.maintenance4},
        {"subgroupSizeControl", &features.vulkan13.subgroupSizeControl},
        {"computeFullSubgroups", &features.vulkan13.computeFullSubgroups},
        {"scalarBlockLayout", &features.vulkan12.scalarBlockLayout},
        {"multiDrawIndirect", &features.chain.features.multiDrawIndirect},
        {"drawIndirectFirstInstance", &features.chain.features.drawIndirectFirstInstance}};
    for (const auto& [name, feature] : needed) {
        CAPTURE_BINDING(name);
        *feature = VK_FALSE;
        CHECK(missingFeature(created).find(name) != std::string::npos);
        *feature = VK_TRUE;
    }
    CHECK_FALSE(hasFeature(created, "shaderOutputLayer"));
    features.vulkan12.shaderOutputLayer = VK_TRUE;
    CHECK(hasFeature(created, "shaderOutputLayer"));
}

TEST_CASE("features: older ways to turn them on count as well") {
    Features features;
    turnOn(features);
    // Those of Vulkan 1.0 without a chain of their own.
    VkDeviceCreateInfo created = createdWith(&features.vulkan12);
    created.pEnabledFeatures = &features.chain.features;
    CHECK(missingFeature(created) == "");
    // A struct of the extension that a feature came from.
    VkPhysicalDeviceSynchronization2Features synchronization{};
    synchronization.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES;
    synchronization.pNext = &features.chain;
    features.vulkan13.synchronization2 = VK_FALSE;
    CHECK(missingFeature(createdWith(&synchronization)).find("synchronization2") != std::string::npos);
    synchronization.synchronization2 = VK_TRUE;
    CHECK(missingFeature(createdWith(&synchronization)) == "");
    CHECK(missingFeature(createdWith(nullptr)) != "");
}

TEST_CASE("features: a host's device that is incomplete is refused with what is expected") {
    CHECK_THROWS_WITH_AS(vk::Device(vk::HostDevice{}), doctest::Contains("host device: expected instance"),
                         UsageError);
}
