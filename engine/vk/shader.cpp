#include "engine/vk/shader.h"

#include "engine/base/check.h"

#include <memory>
#include <new>
#include <spirv_cross/spirv_cross_c.h>
#include <string_view>
#include <type_traits>

namespace relume::vk {

namespace {

struct DestroyContext {
    void operator()(spvc_context context) const { spvc_context_destroy(context); }
};
using Context = std::unique_ptr<std::remove_pointer_t<spvc_context>, DestroyContext>;

Context makeContext() {
    spvc_context context;
    if (spvc_context_create(&context) != SPVC_SUCCESS) throw std::bad_alloc();
    return Context(context);
}

// Shaders are the program's own: what fails for another reason than memory, which some functions tell only in
// words, is a bug.
void checkSpvc(const Context& context, spvc_result result) {
    if (result == SPVC_SUCCESS) return;
    const std::string_view why = spvc_context_get_last_error_string(context.get());
    if (result == SPVC_ERROR_OUT_OF_MEMORY || why.find("bad_alloc") != std::string_view::npos)
        throw std::bad_alloc();
    failCheck("a shader can be read", why, __FILE__, __LINE__);
}

VkShaderStageFlagBits stageOf(SpvExecutionModel model) {
    switch (model) {
    case SpvExecutionModelVertex:
        return VK_SHADER_STAGE_VERTEX_BIT;
    case SpvExecutionModelFragment:
        return VK_SHADER_STAGE_FRAGMENT_BIT;
    default:
        return VK_SHADER_STAGE_COMPUTE_BIT;
    }
}

void addBindings(const Context& context, spvc_compiler compiler, spvc_resources resources,
                 spvc_resource_type type, VkDescriptorType descriptor, ShaderInterface& interface) {
    const spvc_reflected_resource* list;
    size_t count;
    checkSpvc(context, spvc_resources_get_resource_list_for_type(resources, type, &list, &count));
    for (size_t i = 0; i < count; i++) {
        RELUME_CHECK_EQ(spvc_compiler_get_decoration(compiler, list[i].id, SpvDecorationDescriptorSet), 0u);
        interface.bindings[spvc_compiler_get_decoration(compiler, list[i].id, SpvDecorationBinding)] =
            descriptor;
    }
}

uint32_t pushConstantBytes(const Context& context, spvc_compiler compiler, spvc_resources resources) {
    const spvc_reflected_resource* list;
    size_t count;
    checkSpvc(context, spvc_resources_get_resource_list_for_type(resources, SPVC_RESOURCE_TYPE_PUSH_CONSTANT,
                                                                 &list, &count));
    if (count == 0) return 0;
    size_t bytes;
    const spvc_type type = spvc_compiler_get_type_handle(compiler, list[0].base_type_id);
    checkSpvc(context, spvc_compiler_get_declared_struct_size(compiler, type, &bytes));
    return uint32_t(bytes);
}

std::array<uint32_t, 3> groupSize(spvc_compiler compiler, const Constants& constants) {
    std::array<uint32_t, 3> size{1, 1, 1};
    spvc_specialization_constant specialized[3]{};
    spvc_compiler_get_work_group_size_specialization_constants(compiler, &specialized[0], &specialized[1],
                                                               &specialized[2]);
    for (unsigned axis = 0; axis < 3; axis++) {
        size[axis] =
            spvc_compiler_get_execution_mode_argument_by_index(compiler, SpvExecutionModeLocalSize, axis);
        if (specialized[axis].id == 0) continue;
        RELUME_CHECK_LT(specialized[axis].constant_id, constants.size());
        size[axis] = constants[specialized[axis].constant_id];
    }
    return size;
}

} // namespace

ShaderInterface reflect(std::span<const uint32_t> spirv, const Constants& constants) {
    const Context context = makeContext();
    spvc_parsed_ir ir;
    checkSpvc(context, spvc_context_parse_spirv(context.get(), spirv.data(), spirv.size(), &ir));
    spvc_compiler compiler;
    checkSpvc(context, spvc_context_create_compiler(context.get(), SPVC_BACKEND_NONE, ir,
                                                    SPVC_CAPTURE_MODE_TAKE_OWNERSHIP, &compiler));
    spvc_resources resources;
    checkSpvc(context, spvc_compiler_create_shader_resources(compiler, &resources));

    ShaderInterface interface {};
    interface.stage = stageOf(spvc_compiler_get_execution_model(compiler));
    addBindings(context, compiler, resources, SPVC_RESOURCE_TYPE_STORAGE_BUFFER,
                VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, interface);
    addBindings(context, compiler, resources, SPVC_RESOURCE_TYPE_SAMPLED_IMAGE,
                VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, interface);
    // SPIR-V 1.6 has no samplers for buffers; the shaders use no other images without samplers.
    addBindings(context, compiler, resources, SPVC_RESOURCE_TYPE_SEPARATE_IMAGE,
                VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, interface);
    interface.pushConstantBytes = pushConstantBytes(context, compiler, resources);
    if (interface.stage == VK_SHADER_STAGE_COMPUTE_BIT) interface.groupSize = groupSize(compiler, constants);
    return interface;
}

} // namespace relume::vk
