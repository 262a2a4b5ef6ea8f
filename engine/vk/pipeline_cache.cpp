#include "engine/vk/pipeline_cache.h"

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/base/log.h"
#include "engine/vk/result.h"

#include <algorithm>
#include <cstring>
#include <fmt/core.h>

namespace relume::vk {

namespace {

constexpr size_t kMostBytes = size_t(64) << 20; // per file; larger files are not ours
constexpr char kMagic[] = {'R', 'L', 'M', 'P', 'I', 'P', 'E', 'S'};
constexpr uint32_t kVersion = 1;

// Header of the file. It adds what Vulkan's own header lacks: the driver's version, and a check that the data
// is whole.
struct Header {
    char magic[8];
    uint32_t version;
    uint32_t vendor, device, driverVersion;
    uint8_t uuid[VK_UUID_SIZE];
    uint64_t dataBytes, dataHash;
};
static_assert(sizeof(Header) == 56);

Header headerOf(const VkPhysicalDeviceProperties& driver, std::span<const std::byte> data) {
    Header header{};
    std::ranges::copy(kMagic, header.magic);
    header.version = kVersion;
    header.vendor = driver.vendorID;
    header.device = driver.deviceID;
    header.driverVersion = driver.driverVersion;
    std::ranges::copy(driver.pipelineCacheUUID, header.uuid);
    header.dataBytes = data.size();
    header.dataHash = hash64(data);
    return header;
}

// Returns whether the data starts with Vulkan's header for this device. Compares bytes, since a damaged
// version may not be a valid enumerator, and such a value must not be read.
bool isOfDevice(const VkPhysicalDeviceProperties& driver, std::span<const std::byte> data) {
    VkPipelineCacheHeaderVersionOne expected{
        sizeof expected, VK_PIPELINE_CACHE_HEADER_VERSION_ONE, driver.vendorID, driver.deviceID, {}};
    std::ranges::copy(driver.pipelineCacheUUID, expected.pipelineCacheUUID);
    return data.size() >= sizeof expected && std::memcmp(data.data(), &expected, sizeof expected) == 0;
}

// Returns empty if there is no file, or it cannot be read.
std::vector<std::byte> readIfThere(const std::filesystem::path& path) {
    try {
        return readFile(path, kMostBytes);
    } catch (const std::exception& error) { // the program works without a cache
        log(LogLevel::Debug, fmt::format("pipeline cache: {}", error.what()));
        return {};
    }
}

} // namespace

std::vector<std::byte> packPipelineCache(const VkPhysicalDeviceProperties& driver,
                                         std::span<const std::byte> data) {
    const Header header = headerOf(driver, data);
    std::vector<std::byte> file(sizeof header + data.size());
    std::memcpy(file.data(), &header, sizeof header);
    std::ranges::copy(data, file.begin() + sizeof header);
    return file;
}

std::span<const std::byte> unpackPipelineCache(const VkPhysicalDeviceProperties& driver,
                                               std::span<const std::byte> file) {
    if (file.size() < sizeof(Header)) return {};
    const auto data = file.subspan(sizeof(Header));
    const Header expected = headerOf(driver, data);
    if (std::memcmp(file.data(), &expected, sizeof expected) != 0) return {};
    return isOfDevice(driver, data) ? data : std::span<const std::byte>();
}

PipelineCache::PipelineCache(VkDevice device, const VkPhysicalDeviceProperties& driver,
                             std::filesystem::path path)
    : mDevice(device), mDriver(driver), mPath(std::move(path)) {
    const std::vector<std::byte> file = mPath.empty() ? std::vector<std::byte>() : readIfThere(mPath);
    const auto kept = unpackPipelineCache(mDriver, file);
    if (!mPath.empty())
        log(LogLevel::Debug, fmt::format("pipeline cache: {}: {} bytes of {} are of use", mPath.string(),
                                         kept.size(), file.size()));
    VkPipelineCacheCreateInfo create{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    create.initialDataSize = kept.size();
    create.pInitialData = kept.data();
    mCache = RELUME_VK_CREATE(vkCreatePipelineCache, device, create);
}

PipelineCache::~PipelineCache() { vkDestroyPipelineCache(mDevice, mCache, nullptr); }

std::vector<std::byte> PipelineCache::data() const {
    std::vector<std::byte> bytes;
    VkResult result;
    do { // other threads may add to it between the two calls
        size_t size = 0;
        RELUME_VK(vkGetPipelineCacheData(mDevice, mCache, &size, nullptr));
        bytes.resize(size);
        result = vkGetPipelineCacheData(mDevice, mCache, &size, bytes.data());
        bytes.resize(size);
    } while (result == VK_INCOMPLETE);
    check(result, "vkGetPipelineCacheData");
    return bytes;
}

void PipelineCache::save() const {
    if (mPath.empty()) return;
    try {
        const std::vector<std::byte> file = packPipelineCache(mDriver, data());
        if (file.size() > kMostBytes) {
            log(LogLevel::Debug, fmt::format("pipeline cache: {} bytes are too many to keep", file.size()));
            return;
        }
        std::error_code failure; // the write below reports the folder's problem
        if (mPath.has_parent_path()) std::filesystem::create_directories(mPath.parent_path(), failure);
        writeFileAtomically(mPath, file);
    } catch (const std::exception& error) { // after a lost device, do not fail a second time
        log(LogLevel::Warning, fmt::format("pipelines are not kept for the next start: {}", error.what()));
    }
}

} // namespace relume::vk
