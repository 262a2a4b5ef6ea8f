// Image files made in memory, for tests of what reads them.
#pragma once

#include "engine/scene/texture.h"

#include <stb_image_write.h>
#include <string>
#include <string_view>

namespace relume::test {

inline void appendTo(void* text, void* data, int size) {
    static_cast<std::string*>(text)->append(static_cast<const char*>(data), size_t(size));
}

inline std::string samplePng(const Texture& texture) {
    std::string bytes;
    stbi_write_png_to_func(appendTo, &bytes, texture.width, texture.height, 4, texture.texels.data(), 0);
    return bytes;
}

inline std::string sampleJpeg(const Texture& texture) {
    std::string bytes;
    stbi_write_jpg_to_func(appendTo, &bytes, texture.width, texture.height, 4, texture.texels.data(), 95);
    return bytes;
}

// CRC-32 as PNG has it, high byte first.
inline std::string pngSum(std::string_view bytes) {
    uint32_t sum = 0xffffffff;
    for (const char byte : bytes) {
        sum ^= uint8_t(byte);
        for (int bit = 0; bit < 8; bit++) sum = sum & 1 ? 0xedb88320u ^ sum >> 1 : sum >> 1;
    }
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8) text += char(~sum >> shift & 0xff);
    return text;
}

// The first 33 bytes of an RGBA PNG file of this size: all before the image data.
inline std::string samplePngHeader(uint32_t width, uint32_t height) {
    std::string bytes("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
    for (const uint32_t side : {width, height})
        for (int shift = 24; shift >= 0; shift -= 8) bytes += char(side >> shift & 0xff);
    bytes += std::string("\x08\x06\0\0\0", 5);
    return bytes + pngSum(std::string_view(bytes).substr(12));
}

// Makes every check sum right that the sizes before it let one find.
inline void resealPng(std::string& bytes) {
    for (size_t start = 8; start + 12 <= bytes.size();) {
        size_t size = 0;
        for (size_t i = 0; i < 4; i++) size = size << 8 | uint8_t(bytes[start + i]);
        if (size > bytes.size() - start - 12) return;
        bytes.replace(start + 8 + size, 4, pngSum(std::string_view(bytes).substr(start + 4, size + 4)));
        start += 12 + size;
    }
}

} // namespace relume::test
