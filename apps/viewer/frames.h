// Frames of the window: the view, the panels over it, and what is written of them.
#pragma once

#include "apps/viewer/frame_times.h"
#include "apps/viewer/lamp_handles.h"
#include "apps/viewer/notice.h"
#include "apps/viewer/outputs.h"
#include "apps/viewer/panel_pictures.h"
#include "apps/viewer/ui.h"
#include "engine/render/display_pass.h"

#include <vulkan/vulkan.h>

namespace relume {

// The Vulkan surface of a window.
struct Surface {
    Surface(VkInstance owner, VkSurfaceKHR surface) : instance(owner), handle(surface) {}
    ~Surface() { vkDestroySurfaceKHR(instance, handle, nullptr); }
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    VkInstance instance;
    VkSurfaceKHR handle;
};

class Frames {
  public:
    // References to the contents of a frame, which the viewer owns.
    struct Shown {
        SceneState& state;
        const Content& content;
        SceneView& view;
        const LampHandles& lamps;
        Notice& notice;
    };

    // Keeps references to all of it.
    Frames(Window& window, const vk::Device& device, const Shown& shown, bool waitsForDisplay);

    // Draws and presents a frame in which `seconds` pass, at most a quarter, or a thirtieth while recording:
    // moves what plays, then writes what the outputs want of it. Returns what was pressed in the panels;
    // nothing where the window cannot be drawn on, as a minimized one. Throws Error for files that cannot be
    // written where `mustWrite`, else tells.
    std::optional<PanelRequests> draw(double seconds, bool mustWrite);

    // Draws at least this many frames before the window is idle.
    void want(int frames) { mWanted = std::max(mWanted, frames); }
    bool areWanted() const { return mWanted > 0; }

    // Makes the passes anew, from the shaders that the device has now.
    void remakePrograms();

    Outputs& outputs() { return mOutputs; }
    const Outputs& outputs() const { return mOutputs; }
    PanelPictures& pictures() { return mPictures; }
    const PanelPictures& pictures() const { return mPictures; }

  private:
    bool prepareSwapchain();
    bool submit(const vk::Image& target, uint32_t image);
    void recordView(const vk::Image& target);
    PanelRequests drawUi();
    PanelFacts facts() const;
    void save(bool mustWrite);

    Window& mWindow;
    const vk::Device& mDevice;
    Shown mShown;
    std::unique_ptr<Surface> mSurface;
    vk::Swapchain mSwapchain;
    Ui mUi;
    std::unique_ptr<DisplayPass> mDisplay;
    vk::Commands mCommands;
    Outputs mOutputs;
    PanelPictures mPictures;
    FrameTimes mTimes;
    bool mNeedsSwapchain = true;
    int mWanted = 0;
};

} // namespace relume
