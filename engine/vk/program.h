// Pipelines made from SPIR-V. Their layouts follow from the shaders themselves.
#pragma once

#include "engine/vk/device.h"
#include "engine/vk/shader.h"

namespace relume::vk {

// The base of compute and graphics programs: a pipeline and its layouts, which have descriptor set 0 only.
// Copies share them; an empty program has none. Those that are made on a device from the same SPIR-V,
// constants and options are one, with the name of the first (programs.h).
class Program {
  public:
    Program() = default;

    VkPipeline pipeline() const { return mObjects ? mObjects->pipeline : VK_NULL_HANDLE; }
    VkPipelineLayout layout() const { return mObjects->layout; }
    VkDescriptorSetLayout setLayout() const { return mObjects->setLayout; }
    const std::map<uint32_t, VkDescriptorType>& bindings() const { return mObjects->bindings; }
    uint32_t pushConstantBytes() const { return mObjects->pushConstantBytes; }
    VkShaderStageFlags stages() const { return mObjects->stages; }
    const std::array<uint32_t, 3>& groupSize() const { return mObjects->groupSize; }
    const std::string& name() const { return mObjects->name; }

  protected:
    struct Objects {
        explicit Objects(const Device& on) : device(on) {}
        ~Objects();
        Objects(const Objects&) = delete;
        Objects& operator=(const Objects&) = delete;

        const Device& device;
        std::string name;
        VkPipeline pipeline = VK_NULL_HANDLE;
        VkPipelineLayout layout = VK_NULL_HANDLE;
        VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
        std::map<uint32_t, VkDescriptorType> bindings;
        uint32_t pushConstantBytes = 0;
        VkShaderStageFlags stages = 0;
        std::array<uint32_t, 3> groupSize{1, 1, 1};
    };

    // Returns objects with the layouts that the shaders ask for, and no pipeline yet.
    static std::shared_ptr<Objects>
    makeLayouts(const Device& device, std::span<const ShaderInterface> shaders, std::string_view name);

    std::shared_ptr<const Objects> mObjects;
};

// With Subgroups::Full every subgroup has DeviceInfo::subgroupSize invocations; the group size must be a
// multiple of that.
enum class Subgroups { Any, Full };

// A compute pipeline.
class ComputeProgram : public Program {
  public:
    ComputeProgram() = default;
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

    auto operator<=>(const GraphicsOptions&) const = default;
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
