#include "engine/render/shade_programs.h"

#include "engine/base/parallel.h"
#include "engine/render/view_image.h"
#include "shaders/view_shade_frag.h"
#include "shaders/view_shade_samples_frag.h"
#include "shaders/view_shade_vert.h"

#include <fmt/core.h>

namespace relume {

vk::GraphicsOptions shadeOptions(VkFormat depthFormat, uint32_t stencilBits) {
    return {.colorFormat = kViewColorFormat,
            .depthFormat = depthFormat,
            .depthCompare = VK_COMPARE_OP_ALWAYS,
            .depthWrite = false,
            .stencil = vk::Stencil::Equal,
            .stencilCompared = stencilBits};
}

void ShadePrograms::make(std::span<const ShadeVariant> variants) {
    std::vector<std::pair<const ShadeVariant, vk::GraphicsProgram>*> missing;
    for (const ShadeVariant& variant : variants)
        if (const auto [entry, isNew] = mPrograms.try_emplace(variant); isNew) missing.push_back(&*entry);
    parallelFor(missing.size(), [&](size_t i) { missing[i]->second = makeProgram(missing[i]->first); });
}

const vk::GraphicsProgram& ShadePrograms::get(const ShadeVariant& variant) {
    vk::GraphicsProgram& program = mPrograms[variant];
    if (!program.pipeline()) program = makeProgram(variant);
    return program;
}

vk::GraphicsProgram ShadePrograms::makeProgram(const ShadeVariant& variant) const {
    const bool isOfEdges = variant.pixels == ShadedPixels::Edges;
    // Numbered as in view_shade.frag and lib/pixel_samples.glsl.
    const vk::Constants constants = {variant.terms,
                                     uint32_t(variant.isGray),
                                     variant.look,
                                     uint32_t(variant.allTerms),
                                     variant.estimate,
                                     variant.samples,
                                     uint32_t(isOfEdges),
                                     variant.harmonics,
                                     uint32_t(variant.hasTangents)};
    const std::string name = fmt::format("view of {} terms", variant.terms);
    if (variant.pixels == ShadedPixels::All)
        return {mDevice,   view_shade_vert_spirv,      view_shade_frag_spirv,
                constants, shadeOptions(mDepthFormat), name};
    vk::GraphicsOptions options = shadeOptions(mDepthFormat, isOfEdges ? kEdgeBit : 0xff);
    options.addsColor = isOfEdges;
    return {mDevice,
            view_shade_vert_spirv,
            view_shade_samples_frag_spirv,
            constants,
            options,
            name + (isOfEdges ? ", edges" : "")};
}

} // namespace relume
