#include "engine/relight/set_relighter.h"

#include "engine/base/error.h"
#include "engine/vk/upload.h"

#include <algorithm>
#include <fmt/core.h>

namespace relume {

SetRelighter::SetRelighter(const vk::Device& device, uint64_t rows, size_t lights, const std::string& name) {
    // Padded to whole texels of four floats, as which views read tuples.
    const uint64_t bytes =
        (std::max<uint64_t>(rows, 1) * sizeof(vec3) + sizeof(vec4) - 1) / sizeof(vec4) * sizeof(vec4);
    if (bytes > device.largestStorageBuffer())
        throw Error(fmt::format(
            "{}: {} vertices times terms need {} bytes of tuples; {} binds at most {}; split the mesh "
            "into several parts",
            name, rows, bytes, device.name(), device.largestStorageBuffer()));
    mRows = uint32_t(rows);
    for (size_t light = 0; light < lights; light++)
        mLights.push_back({vk::uploadBytes(device, std::vector<std::byte>(bytes), name + " tuples")});
}

void SetRelighter::record(vk::Commands& commands, const DeviceLight& light, RelightMode mode, LightPart lit) {
    uint64_t& recording = mLights[size_t(lit)].recording;
    const bool follows = recording > 0 && recording == light.recordingBefore;
    recording = light.recording;
    recordLayout(commands, light, follows ? mode : RelightMode::Full, lit);
}

} // namespace relume
