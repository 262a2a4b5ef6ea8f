// Draws a bake into the frame of a program that has a Vulkan device, images and commands of its own:
// foreign_frame BAKE IMAGE.pfm. Relume's own code is between lines of dashes.
#include <cstdio>
#include <fstream>
#include <relume/relume.h>

namespace {

constexpr uint32_t kWidth = 640, kHeight = 480;

void check(VkResult result) {
    if (result != VK_SUCCESS) throw std::runtime_error("Vulkan call failed: " + std::to_string(result));
}

uint32_t memoryType(VkPhysicalDevice physical, uint32_t allowed, VkMemoryPropertyFlags wanted) {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    for (uint32_t type = 0; type < memory.memoryTypeCount; type++)
        if ((allowed >> type & 1) && (memory.memoryTypes[type].propertyFlags & wanted) == wanted) return type;
    throw std::runtime_error("no such memory");
}

// The program's own device. It enables the features that it needs itself, and those that Relume needs.
struct Host {
    VkInstance instance;
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;
    uint32_t family = 0;
    VkCommandPool pool;
    VkCommandBuffer commands;
    relume::vk::Features features;
    VkDeviceCreateInfo created{};

    Host() {
        VkApplicationInfo application{};
        application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
        application.apiVersion = VK_API_VERSION_1_3;
        VkInstanceCreateInfo createInstance{};
        createInstance.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
        createInstance.pApplicationInfo = &application;
        check(vkCreateInstance(&createInstance, nullptr, &instance));
        uint32_t one = 1;
        if (vkEnumeratePhysicalDevices(instance, &one, &physical) < 0 || one == 0)
            throw std::runtime_error("no Vulkan device");

        relume::vk::enableFeatures(physical, features);
        features.chain.features.samplerAnisotropy = VK_FALSE; // a host's own requests go here
        const float priority = 1;
        VkDeviceQueueCreateInfo createQueue{};
        createQueue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
        createQueue.queueFamilyIndex = family;
        createQueue.queueCount = 1;
        createQueue.pQueuePriorities = &priority;
        created.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
        created.pNext = &features.chain;
        created.queueCreateInfoCount = 1;
        created.pQueueCreateInfos = &createQueue;
        check(vkCreateDevice(physical, &created, nullptr, &device));
        vkGetDeviceQueue(device, family, 0, &queue);

        VkCommandPoolCreateInfo createPool{};
        createPool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        createPool.queueFamilyIndex = family;
        check(vkCreateCommandPool(device, &createPool, nullptr, &pool));
        VkCommandBufferAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        allocate.commandPool = pool;
        allocate.commandBufferCount = 1;
        check(vkAllocateCommandBuffers(device, &allocate, &commands));
    }
    ~Host() {
        vkDestroyCommandPool(device, pool, nullptr);
        vkDestroyDevice(device, nullptr);
        vkDestroyInstance(instance, nullptr);
    }
};

// An attachment of the program's own.
struct HostImage {
    const Host& host;
    VkImage image;
    VkDeviceMemory memory;
    VkImageAspectFlags aspect;

    HostImage(const Host& owner, VkFormat format, VkImageAspectFlags aspects, VkImageUsageFlags usage)
        : host(owner), aspect(aspects) {
        VkImageCreateInfo create{};
        create.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
        create.imageType = VK_IMAGE_TYPE_2D;
        create.format = format;
        create.extent = {kWidth, kHeight, 1};
        create.mipLevels = create.arrayLayers = 1;
        create.samples = VK_SAMPLE_COUNT_1_BIT;
        create.usage = usage | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        check(vkCreateImage(host.device, &create, nullptr, &image));
        VkMemoryRequirements needs;
        vkGetImageMemoryRequirements(host.device, image, &needs);
        VkMemoryAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
        allocate.allocationSize = needs.size;
        allocate.memoryTypeIndex = memoryType(host.physical, needs.memoryTypeBits, 0);
        check(vkAllocateMemory(host.device, &allocate, nullptr, &memory));
        check(vkBindImageMemory(host.device, image, memory, 0));
    }
    ~HostImage() {
        vkDestroyImage(host.device, image, nullptr);
        vkFreeMemory(host.device, memory, nullptr);
    }
};

// Orders everything before against everything after; a real program would be more specific.
void transition(const Host& host, VkImage image, VkImageAspectFlags aspect, VkImageLayout from,
                VkImageLayout to) {
    VkImageMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.image = image;
    barrier.subresourceRange = {aspect, 0, 1, 0, 1};
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(host.commands, &dependency);
}

void copy(const Host& host, VkImage from, const HostImage& to, VkImageAspectFlags aspect) {
    VkImageCopy region{};
    region.srcSubresource = region.dstSubresource = {aspect, 0, 0, 1};
    region.extent = {kWidth, kHeight, 1};
    vkCmdCopyImage(host.commands, from, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
}

// A buffer from which the program reads its frame.
struct HostPixels {
    const Host& host;
    VkBuffer buffer;
    VkDeviceMemory memory;
    const float* rgba;

    explicit HostPixels(const Host& owner) : host(owner) {
        VkBufferCreateInfo create{};
        create.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
        create.size = kWidth * kHeight * 4 * sizeof(float);
        create.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
        check(vkCreateBuffer(host.device, &create, nullptr, &buffer));
        VkMemoryRequirements needs;
        vkGetBufferMemoryRequirements(host.device, buffer, &needs);
        VkMemoryAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
        allocate.allocationSize = needs.size;
        allocate.memoryTypeIndex =
            memoryType(host.physical, needs.memoryTypeBits,
                       VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
        check(vkAllocateMemory(host.device, &allocate, nullptr, &memory));
        check(vkBindBufferMemory(host.device, buffer, memory, 0));
        void* mapped;
        check(vkMapMemory(host.device, memory, 0, VK_WHOLE_SIZE, 0, &mapped));
        rgba = static_cast<const float*>(mapped);
    }
    ~HostPixels() {
        vkDestroyBuffer(host.device, buffer, nullptr);
        vkFreeMemory(host.device, memory, nullptr);
    }
};

void submitAndWait(const Host& host) {
    check(vkEndCommandBuffer(host.commands));
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &host.commands;
    check(vkQueueSubmit(host.queue, 1, &submit, VK_NULL_HANDLE));
    check(vkQueueWaitIdle(host.queue));
}

void writePfm(const char* path, const float* rgba) {
    std::ofstream file(path, std::ios::binary);
    file << "PF\n" << kWidth << ' ' << kHeight << "\n-1\n"; // rows from the bottom, little-endian
    for (uint32_t y = kHeight; y-- > 0;)
        for (uint32_t x = 0; x < kWidth; x++)
            file.write(reinterpret_cast<const char*>(rgba + 4 * (size_t(y) * kWidth + x)), 3 * sizeof(float));
    if (!file.flush()) throw std::runtime_error(std::string(path) + ": cannot be written");
}

} // namespace

int main(int count, char** arguments) try {
    if (count != 3) {
        std::fprintf(stderr, "usage: foreign_frame BAKE IMAGE.pfm\n");
        return 2;
    }
    const Host host;

    // ---------------------------------------------------------------------------------------------
    using namespace relume;
    const vk::Device device(
        {host.instance, host.physical, host.device, &host.created, host.queue, host.family});
    const Asset asset = readAsset(arguments[1]);
    LightPass light(device, asset.faceSize);
    light.setLight({.environments = {{std::make_shared<const Environment>(prepareForSampling(makeSky()))}}});
    Relighter relighter(device, asset);
    ViewPass view(device, asset, {.width = kWidth, .height = kHeight});
    const Camera camera =
        defaultCamera(objectBounds(asset), glm::radians(35.0f), float(kWidth) / float(kHeight));
    vk::Commands recorder(device, "relume");
    // ---------------------------------------------------------------------------------------------

    const HostImage color(host, VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_ASPECT_COLOR_BIT,
                          VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const HostImage depth(host, view.depth().options().format, view.depth().aspect(),
                          VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    const HostPixels pixels(host);

    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    check(vkBeginCommandBuffer(host.commands, &begin));

    // ---------------------------------------------------------------------------------------------
    recorder.begin(host.commands);
    light.record(recorder);
    relighter.record(recorder, light);
    view.record(recorder, camera, relighter);
    // ---------------------------------------------------------------------------------------------

    // The host's color and depth start with what Relume drew; the host's own draws would follow.
    for (const HostImage* image : {&color, &depth})
        transition(host, image->image, image->aspect, VK_IMAGE_LAYOUT_UNDEFINED,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    copy(host, view.image().handle(), color, VK_IMAGE_ASPECT_COLOR_BIT);
    transition(host, view.depth().handle(), depth.aspect, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    copy(host, view.depth().handle(), depth, VK_IMAGE_ASPECT_DEPTH_BIT);
    transition(host, view.depth().handle(), depth.aspect, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
               VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL); // back, since Relume draws into it again
    transition(host, depth.image, depth.aspect, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
               VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
    transition(host, color.image, color.aspect, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {kWidth, kHeight, 1};
    vkCmdCopyImageToBuffer(host.commands, color.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels.buffer, 1,
                           &region);
    submitAndWait(host);
    writePfm(arguments[2], pixels.rgba);
} catch (const std::exception& failure) {
    std::fprintf(stderr, "foreign_frame: %s\n", failure.what());
    return 1;
}
