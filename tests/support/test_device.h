// A Vulkan device under validation, for tests that must leave it without a single message.
#pragma once

#include "engine/vk/device.h"

#include <doctest/doctest.h>

namespace relume {

// Returns whether the device rounds corners to 1/256 of a pixel or finer. Most do; SwiftShader rounds to
// 1/16.
inline bool roundsFinely(const vk::Device& device) { return device.limits().subPixelPrecisionBits >= 8; }

// Returns the RMSE that coarse rounding may add to a small image: pixels at silhouettes show another surface
// than their rays meet. On SwiftShader 7 of a knot's 1,268 pixels do; the others have the bits of lavapipe's.
inline double silhouetteError(const vk::Device& device) { return roundsFinely(device) ? 0 : 0.06; }

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
