// Pipelines made from SPIR-V; their layouts come from the shaders themselves.
#pragma once

#include "engine/vk/device.h"
#include "engine/vk/shader.h"

namespace relume::vk {

// What compute and graphics programs share. Descriptor set 0 only.
class Program {
  public:
    Program() = default;
    ~Program() { destroy(); }
    Program(Program&& other) noexcept { *this = std::move(other); }
    Program& operator=(Program&& other) noexcept;

    VkPipeline pipeline() const { return mPipeline; }
    VkPipelineLayout layout() const { return mLayout; }
    VkDescriptorSetLayout setLayout() const { return mSetLayout; }
    const std::map<uint32_t, VkDescriptorType>& bindings() const { return mBindings; }
    uint32_t pushConstantBytes() const { return mPushConstantBytes; }
    VkShaderStageFlags stages() const { return mStages; }
    const std::array<uint32_t, 3>& groupSize() const { return mGroupSize; }
    const std::string& name() const { return mName; }

  protected:
    void createLayout(const Device& device, std::span<const ShaderInterface> shaders, std::string_view name);
    void destroy();

    const Device* mDevice = nullptr;
    VkPipeline mPipeline = VK_NULL_HANDLE;
    VkPipelineLayout mLayout = VK_NULL_HANDLE;
    VkDescriptorSetLayout mSetLayout = VK_NULL_HANDLE;
    std::map<uint32_t, VkDescriptorType> mBindings;
    uint32_t mPushConstantBytes = 0;
    VkShaderStageFlags mStages = 0;
    std::array<uint32_t, 3> mGroupSize{1, 1, 1};
    std::string mName;
};

class ComputeProgram : public Program {
  public:
    ComputeProgram() = default;
    // Subgroups::Full: every subgroup has DeviceInfo::subgroupSize invocations, of which the group size must
    // be a multiple.
    enum class Subgroups { Any, Full };
    ComputeProgram(const Device& device, std::span<const uint32_t> spirv, const Constants& constants,
                   std::string_view name, Subgroups subgroups = Subgroups::Any);
};

// The use of the stencil, with Commands::setStencil()'s value: Write stores it, Equal requires it, Replace
// requires it in `stencilCompared` bits and stores it in `stencilWritten` bits.
enum class Stencil { None, Write, Equal, Replace };

enum class Cull { None, Clockwise }; // which triangles, as they are seen, are not drawn

struct GraphicsOptions {
    VkFormat colorFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
    VkFormat depthFormat = VK_FORMAT_UNDEFINED; // none: no depth test
    VkCompareOp depthCompare = VK_COMPARE_OP_LESS;
    bool depthWrite = true; // false where all depths compare: no depth test
    Cull cull = Cull::None;
    Stencil stencil = Stencil::None;                        // else the depth format must have one
    uint32_t stencilCompared = 0xff, stencilWritten = 0xff; // bits
    bool readsPositions = false; // attribute 0 is a vec3 of Commands::setPositions()
    uint32_t samples = 1;        // of each pixel of what is drawn on
    bool writesColor = true;
    bool addsColor = false; // to what is there; else replaces it
};

// A vertex and a fragment shader drawing triangle lists, viewport and scissor dynamic,
// vertices pulled from storage buffers but for positions.
class GraphicsProgram : public Program {
  public:
    GraphicsProgram() = default;
    GraphicsProgram(const Device& device, std::span<const uint32_t> vertexSpirv,
                    std::span<const uint32_t> fragmentSpirv, const Constants& constants,
                    const GraphicsOptions& options, std::string_view name);
};

} // namespace relume::vk
