// The window and its input events.
#pragma once

#include "engine/math/vector.h"

#include <filesystem>
#include <string>
#include <vector>
#include <vulkan/vulkan.h>

struct GLFWwindow;

namespace relume {

// Limits of a window's size, in pixels.
constexpr ivec2 kSmallestWindow(320, 240);
constexpr int kLargestWindow = 16384;

// An input event. Keys, buttons and modifiers are GLFW's; places are in pixels of the framebuffer, from the
// upper left.
struct InputEvent {
    enum class Kind { Button, Move, Scroll, Key, Drop } kind;
    int code = 0; // of the button or key
    bool isDown = false;
    int modifiers = 0;
    vec2 place{0};                                 // of the cursor; for Scroll, the rotation of the wheel
    std::vector<std::filesystem::path> files = {}; // files dropped
    double seconds = 0;                            // time of a clock; 0 for scripts
    bool isScripted = false;                       // panels do not intercept it
};

class Window {
  public:
    // Throws NoDeviceError if there is no display, or if Vulkan cannot draw on it.
    Window(const std::string& title, ivec2 size);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    GLFWwindow* handle() const { return mWindow; }
    // Returns the extensions for DeviceOptions::surfaceExtensions.
    std::vector<std::string> surfaceExtensions() const;
    // Returns a surface, to be destroyed by vkDestroySurfaceKHR() of the instance.
    VkSurfaceKHR makeSurface(VkInstance instance) const;

    // Processes events; waits for one for at most `seconds`.
    void poll(double seconds);
    // Makes a waiting poll() return. Callable from any thread.
    static void wake();

    // Returns the events since the last call: those of the window system (none when scripted) and added ones,
    // in order.
    std::vector<InputEvent> takeEvents();
    void add(InputEvent event) { mEvents.push_back(std::move(event)); }

    bool wantsClose() const;
    void close();
    // Returns whether the window was resized, uncovered or moved since the last call and must be redrawn.
    bool takeDamage();

    ivec2 size() const; // of the framebuffer
    void resize(int width, int height);
    // Returns the display's scale, by which fonts and sizes are multiplied.
    float scale() const;
    bool isFullScreen() const;
    void setFullScreen(bool fullScreen);
    void setTitle(const std::string& title);

  private:
    GLFWwindow* mWindow = nullptr;
    std::vector<InputEvent> mEvents;
    bool mIsDamaged = true;
    int mPlace[4] = {}; // x, y, width, height when not full screen
};

} // namespace relume
