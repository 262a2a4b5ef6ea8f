// Pipelines made from SPIR-V. Their layouts follow from the shaders themselves.
#pragma once

#include "engine/vk/device.h"
#include "engine/vk/shader.h"

namespace relume::vk {

// The base of compute and graphics programs: pipeline and layouts. Uses descriptor set 0 only.
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

// A compute pipeline.
class ComputeProgram : public Program {
  public:
    ComputeProgram() = default;
    // With Subgroups::Full every subgroup has DeviceInfo::subgroupSize invocations; the group size must be a
    // multiple of that.
    enum class Subgroups { Any, Full };
    ComputeProgram(const Device& device, std::span<const uint32_t> spirv, const Constants& constants,
                   std::string_view name, Subgroups subgroups = Subgroups::Any);
};

// How the stencil is used with Commands::setStencil()'s value: Write stores the value, Equal requires it,
// Replace requires it in the bits `stencilCompared` and stores it in the bits `stencilWritten`.
enum class Stencil { None, Write, Equal, Replace };

enum class Cull { None, Clockwise }; // winding, on screen, of triangles that are not drawn

struct GraphicsOptions {
    VkFormat colorFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
    VkFormat depthFormat = VK_FORMAT_UNDEFINED; // none: no depth test
    VkCompareOp depthCompare = VK_COMPARE_OP_LESS;
    bool depthWrite = true; // false with VK_COMPARE_OP_ALWAYS: no depth test
    Cull cull = Cull::None;
    Stencil stencil = Stencil::None;                        // otherwise the depth format must have a stencil
    uint32_t stencilCompared = 0xff, stencilWritten = 0xff; // bits
    bool readsPositions = false; // attribute 0 is a vec3 from Commands::setPositions()
    uint32_t samples = 1;        // per pixel of the target
    bool writesColor = true;
    bool addsColor = false; // adds to the target's color; otherwise replaces it
};

// A graphics pipeline that draws triangle lists, with dynamic viewport and scissor. Vertex shaders read
// storage buffers by vertex number; positions alone can be a vertex attribute.
class GraphicsProgram : public Program {
  public:
    GraphicsProgram() = default;
    GraphicsProgram(const Device& device, std::span<const uint32_t> vertexSpirv,
                    std::span<const uint32_t> fragmentSpirv, const Constants& constants,
                    const GraphicsOptions& options, std::string_view name);
};

} // namespace relume::vk
