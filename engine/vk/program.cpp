#include "engine/vk/program.h"

#include "engine/base/check.h"
#include "engine/math/vector.h"
#include "engine/vk/image.h"
#include "engine/vk/programs.h"
#include "engine/vk/result.h"

#include <algorithm>
#include <utility>

namespace relume::vk {

namespace {

// A shader module that lives for the creation of a pipeline.
class Module {
  public:
    Module(const Device& device, std::span<const uint32_t> spirv, std::string_view name) : mDevice(device) {
        VkShaderModuleCreateInfo create{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
        create.codeSize = spirv.size_bytes();
        create.pCode = spirv.data();
        mModule = RELUME_VK_CREATE(vkCreateShaderModule, device.handle(), create);
        device.setName(VK_OBJECT_TYPE_SHADER_MODULE, reinterpret_cast<uint64_t>(mModule), name);
    }
    ~Module() { vkDestroyShaderModule(mDevice.handle(), mModule, nullptr); }
    Module(const Module&) = delete;
    Module& operator=(const Module&) = delete;

    VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits flag,
                                          const VkSpecializationInfo& constants) const {
        VkPipelineShaderStageCreateInfo stage{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
        stage.stage = flag;
        stage.module = mModule;
        stage.pName = "main";
        stage.pSpecializationInfo = &constants;
        return stage;
    }

  private:
    const Device& mDevice;
    VkShaderModule mModule = VK_NULL_HANDLE;
};

struct Specialization {
    explicit Specialization(const Constants& constants) {
        for (uint32_t i = 0; i < constants.size(); i++) entries.push_back({i, i * 4, 4});
        info = {uint32_t(entries.size()), entries.data(), constants.size() * 4, constants.data()};
    }
    std::vector<VkSpecializationMapEntry> entries;
    VkSpecializationInfo info;
};

} // namespace

Program::Objects::~Objects() {
    vkDestroyPipeline(device.handle(), pipeline, nullptr);
    vkDestroyPipelineLayout(device.handle(), layout, nullptr);
    vkDestroyDescriptorSetLayout(device.handle(), setLayout, nullptr);
}

std::shared_ptr<Program::Objects>
Program::makeLayouts(const Device& device, std::span<const ShaderInterface> shaders, std::string_view name) {
    auto objects = std::make_shared<Objects>(device);
    objects->name = name;
    std::map<uint32_t, VkDescriptorSetLayoutBinding> merged;
    for (const ShaderInterface& shader : shaders) {
        objects->stages |= shader.stage;
        objects->pushConstantBytes = std::max(objects->pushConstantBytes, shader.pushConstantBytes);
        for (const auto& [binding, type] : shader.bindings) {
            VkDescriptorSetLayoutBinding& entry = merged[binding];
            entry.binding = binding;
            entry.descriptorType = type;
            entry.descriptorCount = 1;
            entry.stageFlags |= shader.stage;
            objects->bindings[binding] = type;
        }
    }
    std::vector<VkDescriptorSetLayoutBinding> list;
    for (const auto& [binding, entry] : merged) list.push_back(entry);
    VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    set.bindingCount = uint32_t(list.size());
    set.pBindings = list.data();
    objects->setLayout = RELUME_VK_CREATE(vkCreateDescriptorSetLayout, device.handle(), set);

    RELUME_CHECK_LE(objects->pushConstantBytes, device.limits().maxPushConstantsSize);
    const VkPushConstantRange range{objects->stages, 0, objects->pushConstantBytes};
    VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &objects->setLayout;
    layout.pushConstantRangeCount = objects->pushConstantBytes ? 1 : 0;
    layout.pPushConstantRanges = &range;
    objects->layout = RELUME_VK_CREATE(vkCreatePipelineLayout, device.handle(), layout);
    device.setName(VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, reinterpret_cast<uint64_t>(objects->setLayout),
                   name);
    device.setName(VK_OBJECT_TYPE_PIPELINE_LAYOUT, reinterpret_cast<uint64_t>(objects->layout), name);
    return objects;
}

ComputeProgram::ComputeProgram(const Device& device, std::span<const uint32_t> spirv,
                               const Constants& constants, std::string_view name, Subgroups subgroups) {
    Programs::Source source{
        .shaders = {device.shader(spirv)}, .constants = constants, .subgroups = subgroups};
    static_cast<Program&>(*this) = device.programs().find(source);
    if (pipeline()) return;
    // A replacement may read less than the built-in shader, which says what is bound.
    const ShaderInterface interface = reflect(device.fitting(spirv), constants);
    const std::array<uint32_t, 3>& groupSize = interface.groupSize;
    RELUME_CHECK_LE(groupSize[0] * groupSize[1] * groupSize[2],
                    device.limits().maxComputeWorkGroupInvocations);
    const std::shared_ptr<Objects> objects = makeLayouts(device, {&interface, 1}, name);
    objects->groupSize = groupSize;

    const Module module(device, source.shaders[0], name);
    const Specialization specialization(constants);
    VkComputePipelineCreateInfo create{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    create.stage = module.stage(VK_SHADER_STAGE_COMPUTE_BIT, specialization.info);
    create.layout = objects->layout;
    const VkPipelineShaderStageRequiredSubgroupSizeCreateInfo size{
        VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO, nullptr,
        device.info().subgroupSize};
    if (subgroups == Subgroups::Full) {
        RELUME_CHECK_EQ(groupSize[0] % device.info().subgroupSize, 0u);
        create.stage.flags |= VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT;
        if (device.info().subgroupSizeCanBeAskedFor) create.stage.pNext = &size;
    }
    RELUME_VK(vkCreateComputePipelines(device.handle(), device.pipelineCache(), 1, &create, nullptr,
                                       &objects->pipeline));
    device.setName(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(objects->pipeline), name);
    mObjects = objects;
    static_cast<Program&>(*this) = device.programs().add(std::move(source), *this);
}

GraphicsProgram::GraphicsProgram(const Device& device, std::span<const uint32_t> vertexSpirv,
                                 std::span<const uint32_t> fragmentSpirv, const Constants& constants,
                                 const GraphicsOptions& options, std::string_view name) {
    Programs::Source source{.shaders = {device.shader(vertexSpirv), device.shader(fragmentSpirv)},
                            .constants = constants,
                            .options = options};
    static_cast<Program&>(*this) = device.programs().find(source);
    if (pipeline()) return;
    const ShaderInterface interfaces[] = {reflect(device.fitting(vertexSpirv), constants),
                                          reflect(device.fitting(fragmentSpirv), constants)};
    const std::shared_ptr<Objects> objects = makeLayouts(device, interfaces, name);

    const Module vertex(device, source.shaders[0], name), fragment(device, source.shaders[1], name);
    const Specialization specialization(constants);
    const VkPipelineShaderStageCreateInfo stages[] = {
        vertex.stage(VK_SHADER_STAGE_VERTEX_BIT, specialization.info),
        fragment.stage(VK_SHADER_STAGE_FRAGMENT_BIT, specialization.info)};
    const VkVertexInputBindingDescription tight{0, sizeof(vec3), VK_VERTEX_INPUT_RATE_VERTEX};
    const VkVertexInputAttributeDescription position{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0};
    VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    input.vertexBindingDescriptionCount = input.vertexAttributeDescriptionCount = options.readsPositions;
    input.pVertexBindingDescriptions = &tight;
    input.pVertexAttributeDescriptions = &position;
    VkPipelineInputAssemblyStateCreateInfo assembly{
        VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = 1;
    viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.lineWidth = 1;
    if (options.cull == Cull::Clockwise) raster.cullMode = VK_CULL_MODE_BACK_BIT; // front: counter-clockwise
    VkPipelineMultisampleStateCreateInfo multisample{
        VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    multisample.rasterizationSamples = VkSampleCountFlagBits(options.samples);
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = options.depthFormat != VK_FORMAT_UNDEFINED &&
                            (options.depthWrite || options.depthCompare != VK_COMPARE_OP_ALWAYS);
    depth.depthWriteEnable = depth.depthTestEnable && options.depthWrite;
    depth.depthCompareOp = options.depthCompare;
    depth.stencilTestEnable = options.stencil != Stencil::None;
    depth.front.compareMask = options.stencilCompared;
    depth.front.compareOp = options.stencil == Stencil::Write ? VK_COMPARE_OP_ALWAYS : VK_COMPARE_OP_EQUAL;
    if (options.stencil == Stencil::Write || options.stencil == Stencil::Replace) {
        depth.front.passOp = VK_STENCIL_OP_REPLACE;
        depth.front.writeMask = options.stencilWritten;
    }
    depth.back = depth.front;
    VkPipelineColorBlendAttachmentState blend{};
    if (options.writesColor)
        blend.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                               VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    if (options.addsColor) {
        blend.blendEnable = VK_TRUE;
        blend.srcColorBlendFactor = blend.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
        blend.srcAlphaBlendFactor = blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    }
    VkPipelineColorBlendStateCreateInfo blending{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blending.attachmentCount = 1;
    blending.pAttachments = &blend;
    const VkDynamicState dynamicStates[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                            VK_DYNAMIC_STATE_STENCIL_REFERENCE};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = options.stencil == Stencil::None ? 2 : 3;
    dynamic.pDynamicStates = dynamicStates;
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachmentFormats = &options.colorFormat;
    rendering.depthAttachmentFormat = options.depthFormat;
    if (hasStencil(options.depthFormat)) rendering.stencilAttachmentFormat = options.depthFormat;

    VkGraphicsPipelineCreateInfo create{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
    create.stageCount = 2;
    create.pStages = stages;
    create.pVertexInputState = &input;
    create.pInputAssemblyState = &assembly;
    create.pViewportState = &viewport;
    create.pRasterizationState = &raster;
    create.pMultisampleState = &multisample;
    create.pDepthStencilState = &depth;
    create.pColorBlendState = &blending;
    create.pDynamicState = &dynamic;
    create.layout = objects->layout;
    RELUME_VK(vkCreateGraphicsPipelines(device.handle(), device.pipelineCache(), 1, &create, nullptr,
                                        &objects->pipeline));
    device.setName(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(objects->pipeline), name);
    mObjects = objects;
    static_cast<Program&>(*this) = device.programs().add(std::move(source), *this);
}

} // namespace relume::vk
