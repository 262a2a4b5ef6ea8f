// A Vulkan device under validation, for tests that must leave it without a single message.
#pragma once

#include "engine/vk/device.h"

#include <doctest/doctest.h>

namespace relume {

// Returns the relative error of a small image, RMSE, that silhouettes alone may make: devices round corners,
// most to 1/256 of a pixel, some to 1/16, and a pixel at a rim shows another surface than its ray meets. On
// SwiftShader seven pixels of a knot's 1,268 do, and the others are those of other devices, bit for bit.
inline double rimError(const vk::Device& device) {
    return device.limits().subPixelPrecisionBits < 8 ? 0.06 : 0.0;
}

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
