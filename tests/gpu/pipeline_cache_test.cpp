// What a driver compiled is kept for the next device, and nothing else is ever given to a driver.
#include "engine/render/display_pass.h"
#include "engine/vk/pipeline_cache.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <cstring>
#include <doctest/doctest.h>
#include <random>
#include <unistd.h>

using namespace relume;

namespace {

using Bytes = std::vector<std::byte>;

VkPhysicalDeviceProperties sampleDriver() {
    VkPhysicalDeviceProperties driver{};
    driver.vendorID = 0x10de;
    driver.deviceID = 0x2335;
    driver.driverVersion = 7;
    for (uint8_t i = 0; i < VK_UUID_SIZE; i++) driver.pipelineCacheUUID[i] = uint8_t(i * 3 + 1);
    return driver;
}

// A cache as that driver would give it.
Bytes sampleData(const VkPhysicalDeviceProperties& driver) {
    Bytes data(1000);
    std::mt19937 random(3);
    for (std::byte& byte : data) byte = std::byte(random());
    VkPipelineCacheHeaderVersionOne header{};
    header.headerSize = sizeof header;
    header.headerVersion = VK_PIPELINE_CACHE_HEADER_VERSION_ONE;
    header.vendorID = driver.vendorID;
    header.deviceID = driver.deviceID;
    std::memcpy(header.pipelineCacheUUID, driver.pipelineCacheUUID, VK_UUID_SIZE);
    std::memcpy(data.data(), &header, sizeof header);
    return data;
}

VkPhysicalDeviceProperties propertiesOf(const vk::Device& device) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(device.physical(), &properties);
    return properties;
}

Bytes dataOf(const vk::Device& device) {
    size_t size = 0;
    REQUIRE_EQ(vkGetPipelineCacheData(device.handle(), device.pipelineCache(), &size, nullptr), VK_SUCCESS);
    Bytes data(size);
    REQUIRE_EQ(vkGetPipelineCacheData(device.handle(), device.pipelineCache(), &size, data.data()),
               VK_SUCCESS);
    return data;
}

// A device that keeps its pipelines in `path`; it makes a program, and says nothing.
Bytes dataAfterUse(const std::filesystem::path& path) {
    const vk::Device device(
        {.select = "", .validation = "core,sync", .surfaceExtensions = {}, .pipelineCache = path});
    const DisplayPass pass(device, VK_FORMAT_R8G8B8A8_UNORM);
    device.savePipelineCache();
    CHECK_EQ(device.validationMessages(), 0);
    return dataOf(device);
}

} // namespace

TEST_CASE("pipeline cache: what was packed is unpacked, damaged anywhere it is not") {
    const VkPhysicalDeviceProperties driver = sampleDriver();
    const Bytes data = sampleData(driver), file = vk::packPipelineCache(driver, data);
    CHECK(std::ranges::equal(vk::unpackPipelineCache(driver, file), data));
    for (size_t i = 0; i < file.size(); i++) {
        CAPTURE(i);
        Bytes damaged = file;
        damaged[i] ^= std::byte(1);
        CHECK(vk::unpackPipelineCache(driver, damaged).empty());
        CHECK(vk::unpackPipelineCache(driver, std::span(file).first(i)).empty());
    }
    Bytes longer = file;
    longer.push_back(std::byte(0));
    CHECK(vk::unpackPipelineCache(driver, longer).empty());
}

TEST_CASE("pipeline cache: another driver's is not unpacked") {
    const VkPhysicalDeviceProperties driver = sampleDriver();
    std::vector<VkPhysicalDeviceProperties> others(4, driver);
    others[0].vendorID++;
    others[1].deviceID++;
    others[2].driverVersion++;
    others[3].pipelineCacheUUID[VK_UUID_SIZE - 1]++;
    for (const VkPhysicalDeviceProperties& other : others) {
        CHECK(vk::unpackPipelineCache(driver, vk::packPipelineCache(other, sampleData(other))).empty());
        CHECK(vk::unpackPipelineCache(other, vk::packPipelineCache(driver, sampleData(driver))).empty());
    }
    // The driver's name on data that begins as Vulkan does not have it, or as another device's.
    for (const size_t at : {0, 4, 8, 12, 16, 31}) {
        CAPTURE(at);
        Bytes data = sampleData(driver);
        data[at] ^= std::byte(8);
        CHECK(vk::unpackPipelineCache(driver, vk::packPipelineCache(driver, data)).empty());
    }
    const Bytes data = sampleData(driver);
    CHECK(vk::unpackPipelineCache(driver, vk::packPipelineCache(driver, std::span(data).first(31))).empty());
}

TEST_CASE("pipeline cache: a device saves what its driver gives") {
    const test::TemporaryFolder folder;
    const auto path = folder.path() / "of" / "its own" / "pipelines";
    const Bytes used = dataAfterUse(path);
    const vk::Device next({.select = "", .validation = "", .surfaceExtensions = {}, .pipelineCache = path});
    const Bytes file = readFile(path);
    const auto kept = vk::unpackPipelineCache(propertiesOf(next), file);
    REQUIRE_FALSE(kept.empty());
    CHECK(std::ranges::equal(kept, used));
    MESSAGE("this driver keeps ", kept.size(), " bytes");
}

TEST_CASE("pipeline cache: a file of no use is replaced") {
    const test::TemporaryFolder folder;
    const auto path = folder.path() / "pipelines";
    dataAfterUse(path);
    const Bytes right = readFile(path);
    // Drivers may give other bytes each time.
    const auto checkKept = [&] {
        const vk::Device device(
            {.select = "", .validation = "", .surfaceExtensions = {}, .pipelineCache = {}});
        CHECK_FALSE(vk::unpackPipelineCache(propertiesOf(device), readFile(path)).empty());
    };
    checkKept();
    Bytes damaged = right, half(right.begin(), right.begin() + ptrdiff_t(right.size() / 2));
    damaged.back() ^= std::byte(1);
    const VkPhysicalDeviceProperties other = sampleDriver();
    for (const Bytes& wrong :
         {damaged, half, Bytes(), Bytes(5000), vk::packPipelineCache(other, sampleData(other))}) {
        writeFileAtomically(path, wrong);
        dataAfterUse(path);
        checkKept();
    }
    writeFileAtomically(path, std::string());
    std::filesystem::resize_file(path, uintmax_t(1) << 40); // holes: reading it would take all memory
    dataAfterUse(path);
    checkKept();
}

TEST_CASE("pipeline cache: where it cannot be kept all goes on") {
    const test::TemporaryFolder folder;
    const auto file = folder.write("file", "of somebody");
    dataAfterUse(file / "pipelines"); // in no folder
    CHECK_EQ(readFile(file).size(), 11);
    dataAfterUse(folder.path());     // a folder
    dataAfterUse("/proc/pipelines"); // even root cannot write there
    dataAfterUse({});
    CHECK_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}
