#include "apps/viewer/pictures.h"

#include "engine/base/check.h"

#include <algorithm>
#include <cstring>
#include <imgui.h>

namespace relume {

namespace {

constexpr int kGap = 1; // between pictures, since the texture is filtered
constexpr int kWidth = 1024 + 16 * kGap, kHeight = 1024;

static_assert(IMGUI_VERSION_NUM < 18800, "from 1.88 on pictures are ImGui_ImplVulkan_AddTexture()'s");

// Returns the image of ImGui's font texture, whose ID is the image's handle.
VkImage textureOf(const ImFontAtlas& fonts) { return reinterpret_cast<VkImage>(fonts.TexID); }

VkImageMemoryBarrier barrierOf(VkImage image, VkImageLayout from, VkImageLayout to, VkAccessFlags before,
                               VkAccessFlags after) {
    VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    barrier.srcAccessMask = before;
    barrier.dstAccessMask = after;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    return barrier;
}

} // namespace

Pictures::Pictures(const vk::Device& device) : mDevice(device) {
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    fonts.TexDesiredWidth = 2 * kWidth;
    mRoom = fonts.AddCustomRectRegular(kWidth, kHeight);
}

Picture Pictures::add(int width, int height) {
    const int wide = width + kGap, high = height + kGap;
    for (Row& row : mRows)
        if (row.height == high && row.used + wide <= kWidth) {
            const Picture picture{{row.used, row.top}, {width, height}};
            row.used += wide;
            return picture;
        }
    const int top = mRows.empty() ? 0 : mRows.back().top + mRows.back().height;
    if (top + high > kHeight || wide > kWidth) return {};
    mRows.push_back({top, high, wide});
    return {{0, top}, {width, height}};
}

void Pictures::set(const Picture& picture, const Image& image) {
    if (!picture) return;
    RELUME_CHECK(ivec2(image.width, image.height) == picture.size);
    Change change{picture, {}};
    change.texels.reserve(image.pixels.size());
    for (const vec4& pixel : image.pixels) {
        uint32_t texel = 0;
        for (int c = 0; c < 4; c++)
            texel |= uint32_t(std::clamp(pixel[c], 0.0f, 1.0f) * 255 + 0.5f) << (8 * c);
        change.texels.push_back(texel);
    }
    std::erase_if(mChanges, [&](const Change& other) { return other.picture.place == picture.place; });
    mChanges.push_back(std::move(change));
}

void Pictures::record(vk::Commands& commands) {
    if (mChanges.empty()) return;
    const ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    const ImFontAtlasCustomRect& room = fonts.CustomRects[mRoom];
    size_t bytes = 0;
    for (const Change& change : mChanges) bytes += std::span(change.texels).size_bytes();
    mStaging = vk::Buffer(mDevice, bytes, vk::BufferUse::Upload, "pictures");
    std::vector<VkBufferImageCopy> copies;
    size_t offset = 0;
    for (const Change& change : mChanges) {
        const std::span<const uint32_t> texels = change.texels;
        std::memcpy(mStaging.map<std::byte>().data() + offset, texels.data(), texels.size_bytes());
        VkBufferImageCopy copy{};
        copy.bufferOffset = offset;
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        copy.imageOffset = {room.X + change.picture.place.x, room.Y + change.picture.place.y, 0};
        copy.imageExtent = {uint32_t(change.picture.size.x), uint32_t(change.picture.size.y), 1};
        copies.push_back(copy);
        offset += texels.size_bytes();
    }
    mChanges.clear();
    commands.recordForeign([&](VkCommandBuffer buffer) {
        constexpr VkImageLayout kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                kWrite = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        const VkImage texture = textureOf(fonts);
        VkImageMemoryBarrier barrier =
            barrierOf(texture, kRead, kWrite, VK_ACCESS_SHADER_READ_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
        vkCmdPipelineBarrier(buffer, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0,
                             0, nullptr, 0, nullptr, 1, &barrier);
        vkCmdCopyBufferToImage(buffer, mStaging.handle(), texture, kWrite, uint32_t(copies.size()),
                               copies.data());
        barrier = barrierOf(texture, kWrite, kRead, VK_ACCESS_TRANSFER_WRITE_BIT, VK_ACCESS_SHADER_READ_BIT);
        vkCmdPipelineBarrier(buffer, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0,
                             0, nullptr, 0, nullptr, 1, &barrier);
    });
}

std::array<vec2, 2> Pictures::cornersOf(const Picture& picture) const {
    const ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    const ImFontAtlasCustomRect& room = fonts.CustomRects[mRoom];
    const vec2 first = vec2(float(room.X), float(room.Y)) + vec2(picture.place);
    const vec2 whole(float(fonts.TexWidth), float(fonts.TexHeight));
    return {first / whole, (first + vec2(picture.size)) / whole};
}

void Pictures::draw(const Picture& picture, float width) const {
    const auto [low, high] = cornersOf(picture);
    const float height = width * float(picture.size.y) / float(picture.size.x);
    ImGui::Image(ImGui::GetIO().Fonts->TexID, {width, height}, {low.x, low.y}, {high.x, high.y});
}

bool Pictures::drawButton(const char* name, const Picture& picture, float width, bool isChosen) const {
    const auto [low, high] = cornersOf(picture);
    const float height = width * float(picture.size.y) / float(picture.size.x);
    ImGui::PushID(name);
    if (isChosen) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_CheckMark));
    const bool isPressed =
        ImGui::ImageButton(ImGui::GetIO().Fonts->TexID, {width, height}, {low.x, low.y}, {high.x, high.y}, 2);
    if (isChosen) ImGui::PopStyleColor();
    ImGui::PopID();
    return isPressed;
}

} // namespace relume
