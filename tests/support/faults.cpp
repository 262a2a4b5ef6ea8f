// Makes the operating system fail at a chosen call: a library for LD_PRELOAD, set by environment variables.
// RELUME_FAULT_PATH   text that paths of affected files contain
// RELUME_FAULT        full (ENOSPC), short (half is written, and the next write is full), kill (SIGKILL
//                     instead of the call)
// RELUME_FAULT_CALL   number of the call that fails, from 1, among write, pwrite, fsync, fdatasync and rename
//                     on such files. All later calls fail, too, as on a full disk
// RELUME_FAULT_SUBMIT number of the vkQueueSubmit2 that fails with VK_ERROR_OUT_OF_DEVICE_MEMORY, from 1
// RELUME_FAULT_EXTENSION       a device extension to hide
// RELUME_FAULT_TIMESTAMP_BITS  valid bits of every queue's timestamps
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <string>
#include <unistd.h>
#include <vulkan/vulkan.h>

namespace {

std::atomic<int> gCalls = 0, gSubmissions = 0;

int number(const char* name) {
    const char* text = std::getenv(name);
    return text ? std::atoi(text) : 0;
}

template <typename Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

bool concerns(const char* path) {
    const char* part = std::getenv("RELUME_FAULT_PATH");
    return part && std::strstr(path, part);
}

bool concerns(int file) {
    char path[PATH_MAX] = "";
    const std::string link = "/proc/self/fd/" + std::to_string(file);
    const ssize_t length = readlink(link.c_str(), path, sizeof path - 1);
    return length > 0 && concerns(path);
}

enum class Fault { None, Full, Short };

// Counts a call and returns how it fails. Does not return from the call that is to be killed.
Fault faultOf(bool isWrite) {
    const char* kind = std::getenv("RELUME_FAULT");
    if (!kind) return Fault::None;
    const int call = ++gCalls, chosen = number("RELUME_FAULT_CALL");
    if (call < chosen) return Fault::None;
    if (!std::strcmp(kind, "kill")) raise(SIGKILL);
    if (!std::strcmp(kind, "short") && isWrite && call == chosen) return Fault::Short;
    return Fault::Full;
}

} // namespace

extern "C" {

ssize_t write(int file, const void* bytes, size_t count) {
    static const auto real = next<ssize_t(int, const void*, size_t)>("write");
    const Fault fault = concerns(file) ? faultOf(true) : Fault::None;
    if (fault == Fault::Full) return errno = ENOSPC, -1;
    return real(file, bytes, fault == Fault::Short ? (count + 1) / 2 : count);
}

ssize_t pwrite(int file, const void* bytes, size_t count, off_t offset) {
    static const auto real = next<ssize_t(int, const void*, size_t, off_t)>("pwrite");
    const Fault fault = concerns(file) ? faultOf(true) : Fault::None;
    if (fault == Fault::Full) return errno = ENOSPC, -1;
    return real(file, bytes, fault == Fault::Short ? (count + 1) / 2 : count, offset);
}

int fsync(int file) {
    static const auto real = next<int(int)>("fsync");
    if (concerns(file) && faultOf(false) != Fault::None) return errno = EIO, -1;
    return real(file);
}

int fdatasync(int file) {
    static const auto real = next<int(int)>("fdatasync");
    if (concerns(file) && faultOf(false) != Fault::None) return errno = EIO, -1;
    return real(file);
}

int rename(const char* from, const char* to) {
    static const auto real = next<int(const char*, const char*)>("rename");
    if (concerns(to) && faultOf(false) != Fault::None) return errno = ENOSPC, -1;
    return real(from, to);
}

VkResult vkQueueSubmit2(VkQueue queue, uint32_t count, const VkSubmitInfo2* submits, VkFence fence) {
    static const auto real =
        next<VkResult(VkQueue, uint32_t, const VkSubmitInfo2*, VkFence)>("vkQueueSubmit2");
    if (++gSubmissions == number("RELUME_FAULT_SUBMIT")) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    return real(queue, count, submits, fence);
}

VkResult vkEnumerateDeviceExtensionProperties(VkPhysicalDevice device, const char* layer, uint32_t* count,
                                              VkExtensionProperties* extensions) {
    static const auto real = next<VkResult(VkPhysicalDevice, const char*, uint32_t*, VkExtensionProperties*)>(
        "vkEnumerateDeviceExtensionProperties");
    const VkResult result = real(device, layer, count, extensions);
    const char* missing = std::getenv("RELUME_FAULT_EXTENSION");
    for (uint32_t i = 0; missing && extensions && i < *count; i++)
        if (!std::strcmp(extensions[i].extensionName, missing)) extensions[i] = extensions[--*count];
    return result;
}

void vkGetPhysicalDeviceQueueFamilyProperties(VkPhysicalDevice device, uint32_t* count,
                                              VkQueueFamilyProperties* families) {
    static const auto real = next<void(VkPhysicalDevice, uint32_t*, VkQueueFamilyProperties*)>(
        "vkGetPhysicalDeviceQueueFamilyProperties");
    real(device, count, families);
    for (uint32_t i = 0; std::getenv("RELUME_FAULT_TIMESTAMP_BITS") && families && i < *count; i++)
        families[i].timestampValidBits = uint32_t(number("RELUME_FAULT_TIMESTAMP_BITS"));
}

} // extern "C"
