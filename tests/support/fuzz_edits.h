// Fuzz input that reaches behind a file's checksums.
#pragma once

#include "tests/support/asset_sample.h"

#include <map>

namespace relume::test {

// The chunks of a file, as they are and as they are stored.
struct EditableFile {
    explicit EditableFile(std::vector<RawChunk> content) : chunks(std::move(content)) {
        for (const RawChunk& chunk : chunks)
            stored.push_back(storeChunk(chunk.tag, chunk.part, chunk.run, chunk.raw));
    }

    std::vector<RawChunk> chunks;
    std::vector<StoredChunk> stored;
};

// A file with edits of its chunks' content; edited chunks are not compressed, which takes most of the time.
// Each edit is 8 bytes: chunk, kind, offset (2), value (4).
inline std::vector<std::byte> editedFile(const EditableFile& file, ByteReader in) {
    std::map<size_t, RawChunk> edited;
    while (in.left() >= 8) {
        const size_t number = in.get<uint8_t>() % file.chunks.size();
        RawChunk& chunk = edited.try_emplace(number, file.chunks[number]).first->second;
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
    ChunkWriter writer;
    for (size_t i = 0; i < file.chunks.size(); i++) {
        const auto found = edited.find(i);
        if (found == edited.end()) {
            writer.addStored(file.stored[i].entry, [&bytes = file.stored[i].bytes] { return bytes; });
        } else {
            const RawChunk& chunk = found->second;
            const size_t size = chunk.raw.size();
            writer.addStored({chunk.tag, chunk.part, chunk.run, 0, size, size, hash64(chunk.raw)},
                             [&chunk] { return chunk.raw; });
        }
    }
    return writer.finish();
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
