// Dear ImGui on a swapchain.
#pragma once

#include "apps/viewer/pictures.h"
#include "apps/viewer/window.h"
#include "engine/vk/commands.h"
#include "engine/vk/swapchain.h"

#include <memory>

namespace relume {

// The input that Dear ImGui claims for panels.
struct UiWants {
    bool mouse, keyboard;
};

class Ui {
  public:
    // Keeps references to `window`, `device` and `swapchain`. Only one may exist at a time.
    Ui(const Window& window, const vk::Device& device, const vk::Swapchain& swapchain);
    ~Ui();
    Ui(const Ui&) = delete;
    Ui& operator=(const Ui&) = delete;

    // To be called when the swapchain has new images.
    void resized();

    // Begin and end a frame; calls of ImGui belong between them.
    void begin();
    void end();

    // Records the pass "ui", which draws the frame as of end() over an image of the swapchain, in
    // COLOR_ATTACHMENT_OPTIMAL before and after.
    void record(vk::Commands& commands, uint32_t image) const;

    void setDark(bool dark);

    Pictures& pictures() { return *mPictures; }
    const Pictures& pictures() const { return *mPictures; }

    // Returns the claims of the last frame.
    static UiWants wants();
    // Whether a slider, field or button of a panel is held or edited.
    static bool isItemHeld();

  private:
    Ui(const vk::Device& device, const vk::Swapchain& swapchain, float scale);
    void destroyFramebuffers();

    const vk::Device& mDevice;
    const vk::Swapchain& mSwapchain;
    float mScale;
    std::unique_ptr<Pictures> mPictures;
    VkDescriptorPool mDescriptors = VK_NULL_HANDLE;
    VkRenderPass mRenderPass = VK_NULL_HANDLE;
    std::vector<VkFramebuffer> mFramebuffers;
};

} // namespace relume
