// Fuzz input that reaches behind a file's checksums.
#pragma once

#include "tests/support/asset_sample.h"

namespace relume::test {

// A file of chunks with edits of their content. Each edit is 8 bytes: chunk, kind, offset (2), value (4).
inline std::vector<std::byte> editedFile(std::vector<RawChunk> chunks, ByteReader in) {
    while (in.left() >= 8) {
        RawChunk& chunk = chunks[in.get<uint8_t>() % chunks.size()];
        const auto kind = in.get<uint8_t>();
        const size_t offset = in.get<uint16_t>() % chunk.raw.size();
        const auto value = in.get<uint32_t>();
        switch (kind % 5) {
        case 0:
            poke(chunk.raw, offset, value, 1);
            break;
        case 1:
            poke(chunk.raw, offset, value, 4);
            break;
        case 2:
            chunk.raw.resize(offset + 1);
            break;
        case 3:
            chunk.raw.insert(chunk.raw.end(), value % 4096, std::byte(value >> 24));
            break;
        case 4:
            chunk.run = value;
            break;
        }
    }
    return fileOf(chunks);
}

// Bytes with edits. Each is 8 bytes: kind (2), offset (2), value (4).
inline std::vector<std::byte> editedBytes(std::vector<std::byte> bytes, ByteReader in) {
    while (in.left() >= 8 && !bytes.empty()) {
        const auto kind = in.get<uint16_t>(), place = in.get<uint16_t>();
        const auto value = in.get<uint32_t>();
        const size_t offset = place % bytes.size();
        switch (kind % 5) {
        case 0:
            poke(bytes, offset, value, 1);
            break;
        case 1:
            poke(bytes, offset, value, 4);
            break;
        case 2:
            bytes.resize(offset + 1);
            break;
        case 3:
            bytes.insert(bytes.begin() + ptrdiff_t(offset), value % 64, std::byte(value >> 24));
            break;
        case 4:
            bytes.erase(bytes.begin() + ptrdiff_t(offset),
                        bytes.begin() + ptrdiff_t(std::min<size_t>(offset + value % 64, bytes.size())));
            break;
        }
    }
    return bytes;
}

} // namespace relume::test
