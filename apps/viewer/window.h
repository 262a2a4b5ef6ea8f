// The window, and what is done to it.
#pragma once

#include "engine/math/vector.h"

#include <filesystem>
#include <string>
#include <vector>
#include <vulkan/vulkan.h>

struct GLFWwindow;

namespace relume {

// Pixels of a window that may be asked for.
constexpr ivec2 kSmallestWindow(320, 240);
constexpr int kLargestWindow = 16384;

// Keys, buttons and modifiers are GLFW's. Places in pixels of the framebuffer, from the upper left.
struct InputEvent {
    enum class Kind { Button, Move, Scroll, Key, Drop } kind;
    int code = 0; // of a button or key
    bool isDown = false;
    int modifiers = 0;
    vec2 place{0};                                 // of the cursor; of Scroll: how far the wheel was turned
    std::vector<std::filesystem::path> files = {}; // that were dropped
    double seconds = 0;                            // of a clock; of a script: 0
    bool isScripted = false;                       // no panel is in its way
};

class Window {
  public:
    // Throws NoDeviceError when there is no display, or Vulkan cannot draw on it.
    Window(const std::string& title, ivec2 size);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    GLFWwindow* handle() const { return mWindow; }
    // What DeviceOptions::surfaceExtensions wants.
    std::vector<std::string> surfaceExtensions() const;
    // To be destroyed with the instance's vkDestroySurfaceKHR.
    VkSurfaceKHR makeSurface(VkInstance instance) const;

    // Looks for events; waits for one for at most so many seconds.
    void poll(double seconds);
    // Makes a poll() that waits return; from any thread.
    static void wake();

    // Since the last time. The window system's own (of a script: none) come in their order.
    std::vector<InputEvent> takeEvents();
    void add(InputEvent event) { mEvents.push_back(std::move(event)); }

    bool wantsClose() const;
    void close();
    // Since the last time: whether it was resized, uncovered or moved, and must be drawn anew.
    bool takeDamage();

    ivec2 size() const; // of the framebuffer
    void resize(int width, int height);
    // How much larger than usual things are to be drawn.
    float scale() const;
    bool isFullScreen() const;
    void setFullScreen(bool fullScreen);
    void setTitle(const std::string& title);

  private:
    GLFWwindow* mWindow = nullptr;
    std::vector<InputEvent> mEvents;
    bool mIsDamaged = true;
    int mPlace[4] = {}; // x, y, width, height of the window when it is not full screen
};

} // namespace relume
