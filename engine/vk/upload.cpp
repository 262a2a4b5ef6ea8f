#include "engine/vk/upload.h"

#include "engine/vk/commands.h"

#include <algorithm>

namespace relume::vk {

namespace {

constexpr uint64_t kLargestStaging = uint64_t(32) << 20;

} // namespace

Buffer uploadBytes(const Device& device, std::span<const std::byte> bytes, std::string_view name) {
    Buffer buffer(device, std::max<uint64_t>(bytes.size(), 4 * sizeof(float)), BufferUse::Device, name);
    if (bytes.empty()) return buffer;
    const Buffer staging(device, std::min<uint64_t>(bytes.size(), kLargestStaging), BufferUse::Upload,
                         "staging");
    Commands commands(device, "upload");
    for (uint64_t start = 0; start < bytes.size(); start += staging.bytes()) {
        const auto chunk = bytes.subspan(start, std::min<uint64_t>(bytes.size() - start, staging.bytes()));
        std::copy(chunk.begin(), chunk.end(), staging.map<std::byte>().begin());
        commands.begin();
        commands.copy(staging, buffer, chunk.size(), 0, start);
        commands.barrier(Stage::Transfer, Stage::Compute);
        commands.barrier(Stage::Transfer, Stage::Draw);
        commands.submitAndWait();
    }
    return buffer;
}

Image uploadImage(const Device& device, const ImageOptions& options, std::span<const std::byte> texels,
                  std::string_view name) {
    Image image(device, options, name);
    const Buffer staging(device, texels.size(), BufferUse::Upload, "image upload");
    std::copy(texels.begin(), texels.end(), staging.map<std::byte>().begin());
    Commands commands(device, "image upload");
    commands.begin();
    commands.transition(image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                        Stage::Transfer, Stage::Transfer);
    commands.copy(staging, image);
    commands.transition(image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                        Stage::Transfer, Stage::Compute);
    commands.submitAndWait();
    return image;
}

std::vector<std::byte> downloadBytes(const Device& device, const Buffer& buffer, uint64_t bytes) {
    RELUME_CHECK_LE(bytes, buffer.bytes());
    std::vector<std::byte> values(bytes);
    if (bytes == 0) return values;
    const Buffer staging(device, std::min(bytes, kLargestStaging), BufferUse::Readback, "staging");
    Commands commands(device, "download");
    for (uint64_t start = 0; start < bytes; start += staging.bytes()) {
        const uint64_t chunk = std::min(bytes - start, staging.bytes());
        commands.begin();
        commands.barrier(Stage::Compute, Stage::Transfer);
        commands.copy(buffer, staging, chunk, start);
        commands.barrier(Stage::Transfer, Stage::Host);
        commands.submitAndWait();
        const auto mapped = staging.map<std::byte>().first(chunk);
        std::copy(mapped.begin(), mapped.end(), values.begin() + std::ptrdiff_t(start));
    }
    return values;
}

} // namespace relume::vk
