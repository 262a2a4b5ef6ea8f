#include "engine/vk/shader_replacement.h"

#include "engine/base/error.h"

#include <fmt/core.h>
#include <memory>
#include <spirv_cross/spirv_cross_c.h>

namespace relume::vk {

namespace {

// The interface of one module, read by SPIRV-Cross.
class Reflection {
  public:
    explicit Reflection(std::span<const uint32_t> spirv) {
        if (spvc_context_create(&mContext) != SPVC_SUCCESS) throw Error("SPIRV-Cross cannot be started");
        mOwner.reset(mContext);
        spvc_parsed_ir ir;
        check(spvc_context_parse_spirv(mContext, spirv.data(), spirv.size(), &ir));
        check(spvc_context_create_compiler(mContext, SPVC_BACKEND_NONE, ir, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP,
                                           &mCompiler));
    }

    std::map<std::string, std::string> describe() {
        addStage();
        addResources();
        addConstants();
        return std::move(mParts);
    }

  private:
    void check(spvc_result result) const {
        if (result != SPVC_SUCCESS)
            throw Error(
                fmt::format("cannot be read as SPIR-V: {}", spvc_context_get_last_error_string(mContext)));
    }

    // Appends to an entry, since two bindings may share a number.
    void add(const std::string& what, const std::string& text) {
        std::string& part = mParts[what];
        part += part.empty() ? text : " and " + text;
    }

    void addStage() {
        const SpvExecutionModel model = spvc_compiler_get_execution_model(mCompiler);
        add("stage", model == SpvExecutionModelVertex      ? "vertex"
                     : model == SpvExecutionModelFragment  ? "fragment"
                     : model == SpvExecutionModelGLCompute ? "compute"
                                                           : fmt::format("execution model {}", int(model)));
        if (model != SpvExecutionModelGLCompute) return;
        spvc_specialization_constant constants[3]{};
        spvc_compiler_get_work_group_size_specialization_constants(mCompiler, &constants[0], &constants[1],
                                                                   &constants[2]);
        std::string size;
        for (unsigned axis = 0; axis < 3; axis++) {
            if (axis > 0) size += " x ";
            if (constants[axis].id != 0)
                size += fmt::format("constant {}", constants[axis].constant_id);
            else
                size += std::to_string(spvc_compiler_get_execution_mode_argument_by_index(
                    mCompiler, SpvExecutionModeLocalSize, axis));
        }
        add("group size", size);
    }

    void addResources() {
        constexpr struct {
            spvc_resource_type type;
            const char* name;
        } kKinds[] = {{SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, "uniform buffer"},
                      {SPVC_RESOURCE_TYPE_STORAGE_BUFFER, "storage buffer"},
                      {SPVC_RESOURCE_TYPE_STAGE_INPUT, "input"},
                      {SPVC_RESOURCE_TYPE_STAGE_OUTPUT, "output"},
                      {SPVC_RESOURCE_TYPE_SUBPASS_INPUT, "subpass input"},
                      {SPVC_RESOURCE_TYPE_STORAGE_IMAGE, "storage image"},
                      {SPVC_RESOURCE_TYPE_SAMPLED_IMAGE, "sampled image"},
                      {SPVC_RESOURCE_TYPE_ATOMIC_COUNTER, "atomic counter"},
                      {SPVC_RESOURCE_TYPE_PUSH_CONSTANT, "push constants"},
                      {SPVC_RESOURCE_TYPE_SEPARATE_IMAGE, "image"},
                      {SPVC_RESOURCE_TYPE_SEPARATE_SAMPLERS, "sampler"},
                      {SPVC_RESOURCE_TYPE_ACCELERATION_STRUCTURE, "acceleration structure"}};
        spvc_resources resources;
        check(spvc_compiler_create_shader_resources(mCompiler, &resources));
        for (const auto& [type, name] : kKinds) {
            const spvc_reflected_resource* list;
            size_t count;
            check(spvc_resources_get_resource_list_for_type(resources, type, &list, &count));
            for (const spvc_reflected_resource& resource : std::span(list, count)) {
                const auto decoration = [&](SpvDecoration which) {
                    return spvc_compiler_get_decoration(mCompiler, resource.id, which);
                };
                const std::string text = typeText(resource.type_id, resource.base_type_id, Names::Nested);
                if (type == SPVC_RESOURCE_TYPE_PUSH_CONSTANT)
                    add(name, text);
                else if (type == SPVC_RESOURCE_TYPE_STAGE_INPUT || type == SPVC_RESOURCE_TYPE_STAGE_OUTPUT)
                    add(fmt::format("{} {}", name, decoration(SpvDecorationLocation)), text);
                else if (const unsigned set = decoration(SpvDecorationDescriptorSet))
                    add(fmt::format("binding {} of set {}", decoration(SpvDecorationBinding), set), text);
                else
                    add(fmt::format("binding {}", decoration(SpvDecorationBinding)),
                        fmt::format("{} {}", name, text));
            }
        }
    }

    void addConstants() {
        const spvc_specialization_constant* list;
        size_t count;
        check(spvc_compiler_get_specialization_constants(mCompiler, &list, &count));
        for (const spvc_specialization_constant& constant : std::span(list, count)) {
            const spvc_type_id type =
                spvc_constant_get_type(spvc_compiler_get_constant_handle(mCompiler, constant.id));
            add(fmt::format("constant {}", constant.constant_id), typeText(type, type, Names::Nested));
        }
    }

    // Member names of a block itself are the shader's own; those of nested structs are shared with C++.
    enum class Names { Nested, All };

    std::string typeText(spvc_type_id id, spvc_type_id baseId, Names names) const {
        const spvc_type type = spvc_compiler_get_type_handle(mCompiler, id);
        const spvc_basetype base = spvc_type_get_basetype(type);
        std::string text = base == SPVC_BASETYPE_STRUCT ? structText(type, baseId, names)
                           : base == SPVC_BASETYPE_SAMPLED_IMAGE || base == SPVC_BASETYPE_IMAGE
                               ? imageText(type)
                               : numberText(type);
        for (unsigned i = spvc_type_get_num_array_dimensions(type); i-- > 0;) {
            const unsigned size = spvc_type_get_array_dimension(type, i);
            text += size == 0 ? "[]" : fmt::format("[{}]", size);
        }
        return text;
    }

    static std::string numberText(spvc_type type) {
        constexpr struct {
            spvc_basetype type;
            const char* name;
        } kNames[] = {{SPVC_BASETYPE_BOOLEAN, "bool"},
                      {SPVC_BASETYPE_INT32, "int"},
                      {SPVC_BASETYPE_UINT32, "uint"},
                      {SPVC_BASETYPE_FP32, "float"}};
        const spvc_basetype base = spvc_type_get_basetype(type);
        std::string text = fmt::format("type {}", int(base));
        for (const auto& [known, name] : kNames)
            if (base == known) text = name;
        if (spvc_type_get_vector_size(type) > 1) text += std::to_string(spvc_type_get_vector_size(type));
        if (spvc_type_get_columns(type) > 1) text += fmt::format("x{}", spvc_type_get_columns(type));
        return text;
    }

    std::string imageText(spvc_type type) const {
        const spvc_type_id sampled = spvc_type_get_image_sampled_type(type);
        return fmt::format("of {}, dimension {}{}", typeText(sampled, sampled, Names::Nested),
                           int(spvc_type_get_image_dimension(type)),
                           spvc_type_get_image_arrayed(type) ? ", layers" : "");
    }

    std::string structText(spvc_type type, spvc_type_id baseId, Names names) const {
        std::string text = "{";
        for (unsigned i = 0; i < spvc_type_get_num_member_types(type); i++) {
            if (i > 0) text += "; ";
            const spvc_type_id member = spvc_type_get_member_type(type, i);
            const spvc_type_id memberBase =
                spvc_type_get_base_type_id(spvc_compiler_get_type_handle(mCompiler, member));
            text += typeText(member, memberBase, Names::All);
            if (names == Names::All)
                text += fmt::format(" {}", spvc_compiler_get_member_name(mCompiler, baseId, i));
            if (spvc_compiler_has_member_decoration(mCompiler, baseId, i, SpvDecorationOffset))
                text += fmt::format(
                    " @{}", spvc_compiler_get_member_decoration(mCompiler, baseId, i, SpvDecorationOffset));
        }
        return text + "}";
    }

    spvc_context mContext = nullptr;
    std::unique_ptr<spvc_context_s, decltype(&spvc_context_destroy)> mOwner{nullptr, spvc_context_destroy};
    spvc_compiler mCompiler = nullptr;
    std::map<std::string, std::string> mParts;
};

} // namespace

std::map<std::string, std::string> describeInterface(std::span<const uint32_t> spirv) {
    return Reflection(spirv).describe();
}

void expectSameInterface(const std::string& name, std::span<const uint32_t> builtIn,
                         std::span<const uint32_t> spirv) {
    const auto before = describeInterface(builtIn), after = describeInterface(spirv);
    const auto textIn = [](const std::map<std::string, std::string>& parts, const std::string& what) {
        const auto part = parts.find(what);
        return part == parts.end() ? std::string("nothing") : part->second;
    };
    // The compiler leaves these out where they are declared but never read.
    const auto mayLack = [](std::string_view what) {
        return what.starts_with("binding") || what.starts_with("input") || what == "push constants";
    };
    std::map<std::string, std::string> all = before;
    all.insert(after.begin(), after.end());
    for (const auto& [what, text] : all)
        if (textIn(before, what) != textIn(after, what) && !(mayLack(what) && !after.contains(what)))
            throw Error(fmt::format(
                "{}: {}: found {}, but this program was built for {}; build it again", name, what,
                after.contains(what) ? after.at(what) : "nothing that reads it", textIn(before, what)));
}

} // namespace relume::vk
