// Fuzz target of the image readers: an input is a file. With a first corpus of small .exr and .hdr files it
// reaches behind their headers.
#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/import/image_codecs.h"

#include <cmath>

using namespace relume;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    try {
        const Image image = decodeImage(std::as_bytes(std::span(data, size)), "input").image;
        // What can be read is whole and finite.
        RELUME_CHECK(image.width > 0 && image.height > 0);
        RELUME_CHECK_EQ(image.pixels.size(), size_t(image.width) * size_t(image.height));
        for (const vec4& pixel : image.pixels)
            for (int c = 0; c < 4; c++) RELUME_CHECK(std::isfinite(pixel[c]));
    } catch (const Error&) {
    }
    return 0;
}
