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

} // namespace relume::test
