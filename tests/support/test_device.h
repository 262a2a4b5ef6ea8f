// A Vulkan device under validation, for tests that must leave it without a single message.
#pragma once

#include "engine/vk/device.h"
#include "tests/support/validation.h"

#include <doctest/doctest.h>

namespace relume {

// Returns whether the device rounds corners to 1/256 of a pixel or finer. Most do; SwiftShader rounds to
// 1/16.
inline bool roundsFinely(const vk::Device& device) { return device.limits().subPixelPrecisionBits >= 8; }

// Returns the RMSE that coarse rounding may add to a small image: pixels at silhouettes show another surface
// than their rays meet. On SwiftShader 7 of a knot's 1,268 pixels do; the others have the bits of lavapipe's.
inline double silhouetteError(const vk::Device& device) { return roundsFinely(device) ? 0 : 0.06; }

// Returns whether shaders that differ give equal floats, and samplers filter float texels with float weights.
// Software devices do; GPUs contract expressions as it suits each shader, and round weights to about 8 bits.
inline bool isSoftware(const vk::Device& device) { return device.info().isSoftware; }

// Returns the share of the largest radiance by which the rounding of samplers may change a pixel of random
// maps: 0.3 to 1.1 % on an H200.
inline float filterError(const vk::Device& device) { return isSoftware(device) ? 1e-4f : 0.02f; }

class TestDevice {
  public:
    explicit TestDevice(bool leastFeatures = false)
        : mDevice(vk::DeviceOptions{.validation = testValidation(), .leastFeatures = leastFeatures}) {}
    ~TestDevice() { CHECK_EQ(mDevice.validationMessages(), 0); }

    operator const vk::Device&() const { return mDevice; }

  private:
    vk::Device mDevice;
};

} // namespace relume
