// OpenEXR files as other programs write them: half floats, in any compression, in lines or tiles.
#pragma once

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <filesystem>
#include <vector>

namespace relume::test {

// Writes channels in tiles where the header describes them, otherwise in lines.
inline void writePlanes(const std::filesystem::path& path, const Imf::Header& header,
                        const Imf::FrameBuffer& source) {
    if (header.hasTileDescription()) {
        Imf::TiledOutputFile file(path.c_str(), header);
        file.setFrameBuffer(source);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    } else {
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(source);
        file.writePixels(header.dataWindow().size().y + 1);
    }
}

// Writes half-float channels, each the column number plus ten times the row plus its place in `names`.
inline void writeHalves(const std::filesystem::path& path, Imf::Header header,
                        const std::vector<const char*>& names) {
    const Imath::Box2i window = header.dataWindow();
    const size_t width = size_t(window.max.x - window.min.x + 1),
                 height = size_t(window.max.y - window.min.y + 1);
    std::vector<std::vector<half>> planes(names.size(), std::vector<half>(width * height));
    Imf::FrameBuffer source;
    for (size_t n = 0; n < names.size(); n++) {
        for (size_t i = 0; i < width * height; i++)
            planes[n][i] = float(i % width) + 10 * float(i / width) + float(n);
        header.channels().insert(names[n], Imf::Channel(Imf::HALF));
        source.insert(names[n], Imf::Slice::Make(Imf::HALF, planes[n].data(), window, sizeof(half),
                                                 sizeof(half) * width));
    }
    writePlanes(path, header, source);
}

} // namespace relume::test
