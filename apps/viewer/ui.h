// Dear ImGui on a swapchain.
#pragma once

#include "apps/viewer/pictures.h"
#include "apps/viewer/window.h"
#include "engine/vk/commands.h"
#include "engine/vk/swapchain.h"

#include <memory>

namespace relume {

// Whether input is for panels.
struct UiWants {
    bool mouse, keyboard;
};

class Ui {
  public:
    // `window` and `device` must outlive this. One at a time.
    Ui(const Window& window, const vk::Device& device, const vk::Swapchain& swapchain);
    ~Ui();
    Ui(const Ui&) = delete;
    Ui& operator=(const Ui&) = delete;

    // The swapchain's images are other ones now.
    void resized();

    // ImGui calls belong between begin() and end().
    void begin();
    void end();

    // Pass "ui": draws what was there at end() over the swapchain's image, in COLOR_ATTACHMENT_OPTIMAL before
    // and after.
    void record(vk::Commands& commands, uint32_t image) const;

    void setDark(bool dark);

    Pictures& pictures() { return *mPictures; }
    const Pictures& pictures() const { return *mPictures; }

    // As of the last frame.
    static UiWants wants();
    // Whether a slider, field or button of a panel is held or edited.
    static bool isItemHeld();

  private:
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
