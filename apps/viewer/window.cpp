#define GLFW_INCLUDE_VULKAN
#include "apps/viewer/window.h"

#include "engine/base/error.h"

#include <GLFW/glfw3.h>
#include <fmt/core.h>
#include <utility>

namespace relume {

namespace {

// Returns GLFW's description of its last error.
std::string lastError() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : "for no reason that is known";
}

Window& of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

vec2 cursorOf(GLFWwindow* window, double x, double y) {
    int width = 1, height = 1, pixelsAcross = 1, pixelsDown = 1;
    glfwGetWindowSize(window, &width, &height);
    glfwGetFramebufferSize(window, &pixelsAcross, &pixelsDown);
    return {float(x * pixelsAcross / std::max(1, width)), float(y * pixelsDown / std::max(1, height))};
}

vec2 cursorOf(GLFWwindow* window) {
    double x = 0, y = 0;
    glfwGetCursorPos(window, &x, &y);
    return cursorOf(window, x, y);
}

} // namespace

Window::Window(const std::string& title, ivec2 size) {
    constexpr const char* kNoDisplay =
        "no window can be opened: {}; is a display there (DISPLAY or WAYLAND_DISPLAY)? `relume render` draws "
        "without one";
    if (!glfwInit()) throw NoDeviceError(fmt::format(kNoDisplay, lastError()));
    if (!glfwVulkanSupported()) {
        glfwTerminate();
        throw NoDeviceError("this display cannot show what Vulkan draws; `relume render` draws without one");
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    mWindow = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
    if (!mWindow) {
        const std::string why = lastError();
        glfwTerminate();
        throw NoDeviceError(fmt::format(kNoDisplay, why));
    }
    glfwSetWindowSizeLimits(mWindow, kSmallestWindow.x, kSmallestWindow.y, GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwSetWindowUserPointer(mWindow, this);
    using Kind = InputEvent::Kind;
    glfwSetMouseButtonCallback(mWindow, [](GLFWwindow* window, int button, int action, int modifiers) {
        of(window).add(
            {Kind::Button, button, action == GLFW_PRESS, modifiers, cursorOf(window), {}, glfwGetTime()});
    });
    glfwSetCursorPosCallback(mWindow, [](GLFWwindow* window, double x, double y) {
        of(window).add({Kind::Move, 0, false, 0, cursorOf(window, x, y)});
    });
    glfwSetScrollCallback(mWindow, [](GLFWwindow* window, double x, double y) {
        of(window).add({Kind::Scroll, 0, false, 0, {float(x), float(y)}});
    });
    glfwSetKeyCallback(mWindow, [](GLFWwindow* window, int key, int, int action, int modifiers) {
        if (action == GLFW_REPEAT) return;
        of(window).add({Kind::Key, key, action == GLFW_PRESS, modifiers});
    });
    glfwSetDropCallback(mWindow, [](GLFWwindow* window, int count, const char** paths) {
        InputEvent event{Kind::Drop};
        for (int i = 0; i < count; i++) event.files.emplace_back(paths[i]);
        of(window).add(std::move(event));
    });
    glfwSetWindowRefreshCallback(mWindow, [](GLFWwindow* window) { of(window).mIsDamaged = true; });
    glfwSetFramebufferSizeCallback(mWindow,
                                   [](GLFWwindow* window, int, int) { of(window).mIsDamaged = true; });
}

Window::~Window() {
    glfwDestroyWindow(mWindow);
    glfwTerminate();
}

std::vector<std::string> Window::surfaceExtensions() const {
    uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    if (!names)
        throw NoDeviceError(fmt::format("this display cannot show what Vulkan draws: {}", lastError()));
    return {names, names + count};
}

VkSurfaceKHR Window::makeSurface(VkInstance instance) const {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    if (glfwCreateWindowSurface(instance, mWindow, nullptr, &surface) != VK_SUCCESS)
        throw NoDeviceError(fmt::format("Vulkan cannot draw on this window: {}", lastError()));
    return surface;
}

void Window::poll(double seconds) {
    if (seconds > 0)
        glfwWaitEventsTimeout(seconds);
    else
        glfwPollEvents();
}

void Window::wake() { glfwPostEmptyEvent(); }

std::vector<InputEvent> Window::takeEvents() { return std::exchange(mEvents, {}); }

bool Window::wantsClose() const { return glfwWindowShouldClose(mWindow); }

void Window::close() { glfwSetWindowShouldClose(mWindow, GLFW_TRUE); }

bool Window::takeDamage() { return std::exchange(mIsDamaged, false); }

ivec2 Window::size() const {
    ivec2 size(0);
    glfwGetFramebufferSize(mWindow, &size.x, &size.y);
    return size;
}

void Window::resize(int width, int height) { glfwSetWindowSize(mWindow, width, height); }

float Window::scale() const {
    float x = 1, y = 1;
    glfwGetWindowContentScale(mWindow, &x, &y);
    return x > 0 ? x : 1;
}

bool Window::isFullScreen() const { return glfwGetWindowMonitor(mWindow) != nullptr; }

void Window::setFullScreen(bool fullScreen) {
    if (fullScreen == isFullScreen()) return;
    if (!fullScreen) {
        glfwSetWindowMonitor(mWindow, nullptr, mPlace[0], mPlace[1], mPlace[2], mPlace[3], 0);
        return;
    }
    GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode* const mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
    if (!mode) return;
    glfwGetWindowPos(mWindow, &mPlace[0], &mPlace[1]);
    glfwGetWindowSize(mWindow, &mPlace[2], &mPlace[3]);
    glfwSetWindowMonitor(mWindow, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void Window::setTitle(const std::string& title) { glfwSetWindowTitle(mWindow, title.c_str()); }

} // namespace relume
