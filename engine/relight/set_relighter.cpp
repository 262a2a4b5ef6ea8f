#include "engine/relight/set_relighter.h"

#include "engine/base/error.h"
#include "engine/vk/upload.h"

#include <algorithm>
#include <fmt/format.h>

namespace relume {

SetRelighter::SetRelighter(const vk::Device& device, uint64_t rows, const std::string& name) {
    const uint64_t bytes = std::max<uint64_t>(rows, 1) * sizeof(vec3);
    if (bytes > device.largestStorageBuffer())
        throw Error(fmt::format(
            "{}: {} vertices times terms need {} bytes of tuples; {} binds at most {}; split the mesh "
            "into several parts",
            name, rows, bytes, device.name(), device.largestStorageBuffer()));
    mRows = uint32_t(rows);
    mTuples = vk::uploadBytes(device, std::vector<std::byte>(bytes), name + " tuples");
}

void SetRelighter::record(vk::Commands& commands, const DeviceLight& light, RelightMode mode) {
    const bool follows = mRecording > 0 && mRecording == light.recordingBefore;
    mRecording = light.recording;
    recordLayout(commands, light, follows ? mode : RelightMode::Full);
}

} // namespace relume
