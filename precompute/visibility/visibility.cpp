#include "precompute/visibility/visibility.h"

#include "engine/base/log.h"
#include "precompute/visibility/raster_visibility.h"
#include "precompute/visibility/traced_visibility.h"

#include <fmt/core.h>

namespace relume {

std::string_view visibilityMethodName(VisibilityMethod method) {
    return method == VisibilityMethod::Raster ? "raster" : "traced";
}

bool canUse(const vk::Device& device, VisibilityMethod method) {
    return method == VisibilityMethod::Raster || device.info().hasBallots();
}

VisibilityMethod usableMethod(const vk::Device& device, VisibilityMethod method) {
    if (canUse(device, method)) return method;
    log(LogLevel::Warning, fmt::format("visibility: drawn, since {} cannot trace: that takes subgroups of 8 "
                                       "to 64 that vote, its have {}",
                                       device.name(), device.info().subgroupSize));
    return VisibilityMethod::Raster;
}

Kernels visibilityKernels(VisibilityMethod method) {
    return method == VisibilityMethod::Traced ? TracedVisibility::kernels() : RasterVisibility::kernels();
}

std::unique_ptr<Visibility> makeVisibility(const vk::Device& device, VisibilityMethod method,
                                           const Mesh& occluder, uint32_t size, uint32_t capacity,
                                           float nearDistance) {
    if (method == VisibilityMethod::Traced) return std::make_unique<TracedVisibility>(device, occluder, size);
    return std::make_unique<RasterVisibility>(device, occluder, size, capacity, nearDistance);
}

} // namespace relume
