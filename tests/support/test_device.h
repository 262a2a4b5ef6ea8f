// A Vulkan device under validation, for tests that must leave it without a single message.
#pragma once

#include "engine/vk/device.h"

#include <doctest/doctest.h>

namespace relume {

class TestDevice {
  public:
    TestDevice() : mDevice(vk::DeviceOptions{.select = "", .validation = "core,sync"}) {}
    ~TestDevice() { CHECK_EQ(mDevice.validationMessages(), 0); }

    operator const vk::Device&() const { return mDevice; }

  private:
    vk::Device mDevice;
};

} // namespace relume
