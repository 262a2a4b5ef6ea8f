#include "apps/relume/commands.h"
#include "engine/base/error.h"
#include "engine/vk/device.h"

#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

std::string mebibytes(uint64_t bytes) { return fmt::format("{} MiB", bytes >> 20); }

void printTable(const std::vector<vk::DeviceInfo>& devices) {
    for (const vk::DeviceInfo& device : devices) {
        fmt::print("{}: {}\n", device.index, device.name);
        fmt::print("   type              {}\n", device.type);
        fmt::print("   driver            {}\n", device.driver);
        fmt::print("   Vulkan            {}\n", device.apiVersion);
        fmt::print("   UUID              {}\n", device.uuid);
        fmt::print("   largest heap      {}\n", mebibytes(device.largestHeap));
        fmt::print("   largest buffer    {} bound, {} allocated\n", mebibytes(device.largestStorageBuffer),
                   mebibytes(device.largestAllocation));
        fmt::print("   layers            {}\n", device.largestLayerCount);
        fmt::print("   shared memory     {} bytes\n", device.sharedMemory);
        fmt::print("   layered drawing   {}\n", device.outputsLayers ? "yes" : "no: faces one by one");
        fmt::print("   subgroup size     {}\n", device.subgroupSize);
        fmt::print("   usable            {}\n",
                   device.unsuitable.empty() ? "yes" : "no: " + device.unsuitable);
    }
}

void printJson(const std::vector<vk::DeviceInfo>& devices) {
    auto list = nlohmann::json::array();
    for (const vk::DeviceInfo& device : devices)
        list.push_back({{"index", device.index},
                        {"name", device.name},
                        {"type", device.type},
                        {"driver", device.driver},
                        {"api_version", device.apiVersion},
                        {"uuid", device.uuid},
                        {"largest_heap", device.largestHeap},
                        {"largest_allocation", device.largestAllocation},
                        {"largest_storage_buffer", device.largestStorageBuffer},
                        {"largest_layer_count", device.largestLayerCount},
                        {"shared_memory", device.sharedMemory},
                        {"outputs_layers", device.outputsLayers},
                        {"subgroup_size", device.subgroupSize},
                        {"usable", device.unsuitable.empty()},
                        {"why_not", device.unsuitable}});
    fmt::print("{}\n", list.dump(2));
}

} // namespace

void addDevicesCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("devices", "List the Vulkan devices and the limits that matter");
    const auto json = std::make_shared<bool>(false);
    command->add_flag("--json", *json, "Print JSON");
    command->callback([json] {
        const std::vector<vk::DeviceInfo> devices = vk::listDevices();
        if (devices.empty())
            throw NoDeviceError(
                "no Vulkan device was found; on Debian, mesa-vulkan-drivers brings a software one");
        if (*json)
            printJson(devices);
        else
            printTable(devices);
    });
}

} // namespace relume
