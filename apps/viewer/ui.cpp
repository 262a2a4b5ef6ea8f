#include "apps/viewer/ui.h"

#include "engine/vk/result.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <cmath>
#include <imgui.h>

namespace relume {

namespace {

// Makes a render pass that draws over the image, since ImGui's backend does not support dynamic rendering.
VkRenderPass makeRenderPass(const vk::Device& device, VkFormat format) {
    VkAttachmentDescription color{};
    color.format = format;
    color.samples = VK_SAMPLE_COUNT_1_BIT;
    color.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    color.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    color.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    color.initialLayout = color.finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &reference;
    VkRenderPassCreateInfo create{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
    create.attachmentCount = 1;
    create.pAttachments = &color;
    create.subpassCount = 1;
    create.pSubpasses = &subpass;
    const VkRenderPass pass = RELUME_VK_CREATE(vkCreateRenderPass, device.handle(), create);
    device.setName(VK_OBJECT_TYPE_RENDER_PASS, reinterpret_cast<uint64_t>(pass), "ui");
    return pass;
}

VkDescriptorPool makeDescriptorPool(const vk::Device& device) {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8};
    VkDescriptorPoolCreateInfo create{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    create.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    create.maxSets = 8;
    create.poolSizeCount = 1;
    create.pPoolSizes = &size;
    return RELUME_VK_CREATE(vkCreateDescriptorPool, device.handle(), create);
}

} // namespace

Ui::Ui(const vk::Device& device, const vk::Swapchain& swapchain, float scale)
    : mDevice(device), mSwapchain(swapchain), mScale(scale) {
    ImGui::CreateContext();
}

// Delegates, so that the destructor runs if an object cannot be made.
Ui::Ui(const Window& window, const vk::Device& device, const vk::Swapchain& swapchain)
    : Ui(device, swapchain, window.scale()) {
    mDescriptors = makeDescriptorPool(device);
    mRenderPass = makeRenderPass(device, swapchain.format());
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr; // the viewer saves its own preferences
    io.LogFilename = nullptr;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    ImFontConfig font;
    font.SizePixels = std::floor(13 * mScale);
    io.Fonts->AddFontDefault(&font);
    mPictures = std::make_unique<Pictures>(device);
    setDark(true);
    ImGui_ImplGlfw_InitForVulkan(window.handle(), true);
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = device.instance();
    info.PhysicalDevice = device.physical();
    info.Device = device.handle();
    info.QueueFamily = device.queueFamily();
    info.Queue = device.queue();
    info.PipelineCache = device.pipelineCache();
    info.DescriptorPool = mDescriptors;
    info.MinImageCount = info.ImageCount = 2;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.CheckVkResultFn = [](VkResult result) { vk::check(result, "Dear ImGui"); };
    ImGui_ImplVulkan_Init(&info, mRenderPass);
    vk::Commands commands(device, "ui fonts");
    commands.begin();
    commands.recordForeign([](VkCommandBuffer buffer) { ImGui_ImplVulkan_CreateFontsTexture(buffer); });
    commands.submitAndWait();
    ImGui_ImplVulkan_DestroyFontUploadObjects();
}

Ui::~Ui() {
    if (ImGui::GetIO().BackendRendererUserData) ImGui_ImplVulkan_Shutdown();
    if (ImGui::GetIO().BackendPlatformUserData) ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    destroyFramebuffers();
    vkDestroyRenderPass(mDevice.handle(), mRenderPass, nullptr);
    vkDestroyDescriptorPool(mDevice.handle(), mDescriptors, nullptr);
}

void Ui::destroyFramebuffers() {
    for (VkFramebuffer framebuffer : mFramebuffers)
        vkDestroyFramebuffer(mDevice.handle(), framebuffer, nullptr);
    mFramebuffers.clear();
}

void Ui::resized() {
    destroyFramebuffers();
    mFramebuffers.reserve(mSwapchain.images().size()); // nothing may throw between creation and ownership
    for (const vk::Image& image : mSwapchain.images()) {
        const VkImageView view = image.view();
        VkFramebufferCreateInfo create{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
        create.renderPass = mRenderPass;
        create.attachmentCount = 1;
        create.pAttachments = &view;
        create.width = mSwapchain.width();
        create.height = mSwapchain.height();
        create.layers = 1;
        mFramebuffers.push_back(RELUME_VK_CREATE(vkCreateFramebuffer, mDevice.handle(), create));
    }
}

void Ui::begin() {
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Ui::end() { ImGui::Render(); }

void Ui::record(vk::Commands& commands, uint32_t image) const {
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = mRenderPass;
    begin.framebuffer = mFramebuffers.at(image);
    begin.renderArea.extent = {mSwapchain.width(), mSwapchain.height()};
    commands.barrier(vk::Stage::Color, vk::Stage::Color);
    commands.pass("ui", [&] {
        commands.recordForeign([&](VkCommandBuffer buffer) {
            vkCmdBeginRenderPass(buffer, &begin, VK_SUBPASS_CONTENTS_INLINE);
            ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), buffer);
            vkCmdEndRenderPass(buffer);
        });
    });
}

bool Ui::isItemHeld() { return ImGui::IsAnyItemActive(); }

UiWants Ui::wants() {
    const ImGuiIO& io = ImGui::GetIO();
    return {io.WantCaptureMouse, io.WantCaptureKeyboard};
}

void Ui::setDark(bool dark) {
    ImGuiStyle style;
    if (dark)
        ImGui::StyleColorsDark(&style);
    else
        ImGui::StyleColorsLight(&style);
    style.WindowRounding = 4;
    style.FrameRounding = 3;
    style.Colors[ImGuiCol_WindowBg].w = 0.92f;
    const float gray = dark ? 0.62f : 0.4f; // hints must be legible, too
    style.Colors[ImGuiCol_TextDisabled] = {gray, gray, gray, 1};
    style.Colors[ImGuiCol_SliderGrab].w = 0.5f; // numbers are drawn over it
    style.Colors[ImGuiCol_SliderGrabActive].w = 0.7f;
    style.ScaleAllSizes(mScale);
    ImGui::GetStyle() = style;
}

} // namespace relume
