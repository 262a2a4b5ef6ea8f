// The programs that shade the pixels of a view: variants of view_shade.frag, made once each.
#pragma once

#include "engine/vk/program.h"

#include <map>
#include <span>

namespace relume {

constexpr uint32_t kEdgeBit = 0x80; // of the stencil: marks edges where pixels have several samples

// The pixels that a program shades: All with one sample per pixel; with several, Inner ones are shaded once
// and Edges once per group of samples.
enum class ShadedPixels { All, Inner, Edges };

// The choice of a program. What is not in it may change from draw to draw.
struct ShadeVariant {
    uint32_t terms;    // K of the set
    bool isGray;       // whether its view maps have one channel
    uint32_t look;     // shared::kSingleLook and so on
    bool allTerms;     // whether all K are summed
    uint32_t estimate; // shared::kTermsAlone and so on
    uint32_t samples;  // per pixel
    ShadedPixels pixels;
    uint32_t harmonics; // the most of the bound layers' lit spheres; 0: none
    bool hasTangents;   // whether frames follow from tangents

    auto operator<=>(const ShadeVariant&) const = default;
};

// Returns options of passes that shade pixels whose stencil equals the part's value in these bits.
vk::GraphicsOptions shadeOptions(VkFormat depthFormat, uint32_t stencilBits = 0xff);

// The programs that a view has needed so far, on one device.
class ShadePrograms {
  public:
    // Keeps a reference to the device.
    ShadePrograms(const vk::Device& device, VkFormat depthFormat)
        : mDevice(device), mDepthFormat(depthFormat) {}

    // Makes those of the programs that are missing, side by side: a driver takes a tenth to three tenths of a
    // second for each.
    void make(std::span<const ShadeVariant> variants);

    // Returns a program, which is made if it is missing. It stays where it is.
    const vk::GraphicsProgram& get(const ShadeVariant& variant);

  private:
    vk::GraphicsProgram makeProgram(const ShadeVariant& variant) const;

    const vk::Device& mDevice;
    VkFormat mDepthFormat;
    std::map<ShadeVariant, vk::GraphicsProgram> mPrograms;
};

} // namespace relume
