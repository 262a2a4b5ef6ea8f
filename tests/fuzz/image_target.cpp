// Readers of images: an input is a file, OpenEXR or Radiance.
#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/import/image_codecs.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/exr_sample.h"
#include "tests/support/temporary_folder.h"

#include <OpenEXR/ImfCompression.h>
#include <cmath>
#include <stb_image_write.h>

namespace relume::test {

namespace {

void run(std::span<const std::byte> input) {
    try {
        const Image image = decodeImage(input, "input").image;
        // What can be read is whole and finite.
        RELUME_CHECK(image.width > 0 && image.height > 0);
        RELUME_CHECK_EQ(image.pixels.size(), size_t(image.width) * size_t(image.height));
        for (const vec4& pixel : image.pixels)
            for (int c = 0; c < 4; c++) RELUME_CHECK(std::isfinite(pixel[c]));
    } catch (const Error&) {
    }
}

std::vector<Bytes> seeds() {
    Image image(12, 6);
    std::vector<float> colors;
    for (size_t i = 0; i < image.pixels.size(); i++) {
        image.pixels[i] = vec4(float(i % 7), 0.1f * float(i), 1, 1);
        for (int c = 0; c < 3; c++) colors.push_back(image.pixels[i][c]);
    }
    Bytes radiance;
    const auto append = [](void* target, void* data, int size) {
        const auto* const first = static_cast<const std::byte*>(data);
        static_cast<Bytes*>(target)->insert(static_cast<Bytes*>(target)->end(), first, first + size);
    };
    stbi_write_hdr_to_func(append, &radiance, image.width, image.height, 3, colors.data());
    std::vector<Bytes> all = {encodeExr(image), radiance};
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "halves.exr";
    for (const auto compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::PIZ_COMPRESSION,
          Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION}) {
        Imf::Header header(20, 10);
        header.compression() = compression;
        writeHalves(file, header, {"R", "G", "B"});
        all.push_back(readFile(file));
        header.setTileDescription(Imf::TileDescription(8, 4));
        writeHalves(file, header, {"Y"});
        all.push_back(readFile(file));
    }
    Imf::Header layers(64, 32);
    layers.compression() = Imf::DWAA_COMPRESSION;
    writeHalves(file, layers, {"R", "G", "B", "A", "Z", "left.R", "left.G", "left.B"});
    all.push_back(readFile(file));
    return all;
}

// 512 pixels of a byte (checkImageSize), of 16 bytes each in memory.
const AddFuzzTarget kAdded({"image", run, seeds, uint64_t(256) << 20, 512 * 16});

} // namespace
} // namespace relume::test
