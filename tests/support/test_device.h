// A Vulkan device under validation, for tests that must leave it without a single message.
#pragma once

#include "engine/vk/device.h"

#include <doctest/doctest.h>

namespace relume {

class TestDevice {
  public:
    explicit TestDevice(bool leastFeatures = false)
        : mDevice(vk::DeviceOptions{.validation = "core,sync", .leastFeatures = leastFeatures}) {}
    ~TestDevice() { CHECK_EQ(mDevice.validationMessages(), 0); }

    operator const vk::Device&() const { return mDevice; }

  private:
    vk::Device mDevice;
};

} // namespace relume
