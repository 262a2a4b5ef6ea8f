#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/base/log.h"
#include "engine/import/exr_check.h"
#include "engine/import/image_codecs.h"

#include <OpenEXR/IexErrnoExc.h>
#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfVersion.h>
#include <fmt/core.h>

#include <cstring>
#include <new>

namespace relume {

namespace {

class MemoryReader : public Imf::IStream {
  public:
    MemoryReader(std::span<const std::byte> bytes, const std::string& name)
        : IStream(name.c_str()), mBytes(bytes) {}

    bool read(char target[], int count) override {
        if (count < 0 || mPosition > mBytes.size() || size_t(count) > mBytes.size() - mPosition)
            throw std::runtime_error("the file ends too early");
        std::memcpy(target, mBytes.data() + mPosition, size_t(count));
        mPosition += size_t(count);
        return mPosition < mBytes.size();
    }
    uint64_t tellg() override { return mPosition; }
    void seekg(uint64_t position) override { mPosition = position; }

  private:
    std::span<const std::byte> mBytes;
    uint64_t mPosition = 0;
};

class MemoryWriter : public Imf::OStream {
  public:
    MemoryWriter() : OStream("memory") {}

    void write(const char source[], int count) override {
        const size_t end = size_t(mPosition) + size_t(count);
        if (bytes.size() < end) bytes.resize(end);
        std::memcpy(bytes.data() + mPosition, source, size_t(count));
        mPosition = end;
    }
    uint64_t tellp() override { return mPosition; }
    void seekp(uint64_t position) override { mPosition = position; }

    std::vector<std::byte> bytes;

  private:
    uint64_t mPosition = 0;
};

// Returns the version and flags of a file long enough to hold them.
int32_t versionOf(std::span<const std::byte> bytes) {
    int32_t version;
    std::memcpy(&version, bytes.data() + 4, sizeof version);
    return version;
}

struct CheckedHeader {
    Imf::Header header;
    size_t bytes;
};

// Reads the header of a single-part image file.
CheckedHeader readHeader(std::span<const std::byte> bytes, const std::string& name) {
    constexpr size_t kPrefixBytes = 8; // magic number, then version and flags
    if (bytes.size() < kPrefixBytes)
        throw Error(fmt::format("{}: the file ends within its OpenEXR header", name));
    int32_t version = versionOf(bytes);
    if (Imf::isMultiPart(version) || Imf::isNonImage(version))
        throw Error(
            fmt::format("{}: expected an OpenEXR file of one part of flat pixels, found a multi-part or deep "
                        "one; save one flat part",
                        name));
    const size_t headerBytes = checkExrHeader(bytes, name);
    MemoryReader reader(bytes, name);
    reader.seekg(kPrefixBytes);
    Imf::Header header;
    header.readFrom(reader, version);
    header.sanityCheck(Imf::isTiled(version));
    if (header.hasType() && !Imf::isImage(header.type()))
        throw Error(fmt::format("{}: expected OpenEXR pixels, found a part of type {}", name, header.type()));
    return {header, headerBytes};
}

size_t bytesPerPixel(const Imf::ChannelList& channels) {
    size_t bytes = 0;
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
        bytes += channel.channel().type == Imf::HALF ? 2 : 4;
    return bytes;
}

// Throws if decoding would need implausibly much memory for the file's size. OpenEXR decodes whole chunks (up
// to 256 rows, or a tile) and stores an 8-byte offset for each. Even a scanline file may describe tiles,
// which nothing has checked.
void checkChunkSizes(const Imf::Header& header, bool isTiled, int64_t width, int64_t height, size_t fileBytes,
                     const std::string& name) {
    constexpr int64_t kMostRows = 256;
    int64_t chunkWidth = width, chunkHeight = kMostRows;
    if (isTiled) {
        chunkWidth = header.tileDescription().xSize;
        chunkHeight = header.tileDescription().ySize;
        const int64_t across = (width + chunkWidth - 1) / chunkWidth;
        const int64_t down = (height + chunkHeight - 1) / chunkHeight;
        if (uint64_t(across) * uint64_t(down) > fileBytes / 8)
            throw Error(fmt::format("{}: OpenEXR header claims {} x {} tiles, more than the file can hold",
                                    name, across, down));
    }
    constexpr double kAlwaysFine = 32 << 20, kExpansion = 4096;
    const double chunkBytes =
        double(chunkWidth) * double(chunkHeight) * double(bytesPerPixel(header.channels()));
    if (chunkBytes > std::max(kAlwaysFine, kExpansion * double(fileBytes)))
        throw Error(fmt::format("{}: OpenEXR header claims chunks of {:.0f} bytes in a file of {}", name,
                                chunkBytes, fileBytes));
}

// Returns whether to read Y alone: if there is none of R, G and B. Throws if the channels are not supported.
bool isLuminance(const Imf::ChannelList& channels, const std::string& name) {
    const bool color = channels.findChannel("R") || channels.findChannel("G") || channels.findChannel("B");
    const bool luminance = !color && channels.findChannel("Y");
    if (!color && !luminance) {
        std::string found;
        for (auto channel = channels.begin(); channel != channels.end() && found.size() < 200; ++channel)
            found += fmt::format(" {}", channel.name());
        throw Error(fmt::format("{}: expected channels R, G, B or Y, found:{}", name,
                                found.empty() ? " none" : found));
    }
    if (luminance && (channels.findChannel("RY") || channels.findChannel("BY")))
        throw Error(fmt::format("{}: luminance-chroma OpenEXR is not supported; save it as RGB", name));
    for (const char* wanted : {"R", "G", "B", "A", "Y"})
        if (const Imf::Channel* channel = channels.findChannel(wanted))
            if (channel->xSampling != 1 || channel->ySampling != 1)
                throw Error(
                    fmt::format("{}: channel {} is subsampled; save it at full resolution", name, wanted));
    return luminance;
}

void warnOfPrimaries(const Imf::Header& header, const std::string& name) {
    if (Imf::hasChromaticities(header) && !(Imf::chromaticities(header) == Imf::Chromaticities()))
        log(LogLevel::Warning, fmt::format("{}: primaries other than sRGB's are taken for sRGB's", name));
}

ImageProjection projectionOf(const Imf::Header& header, const std::string& name) {
    if (!Imf::hasEnvmap(header)) return ImageProjection::None;
    const int kind = int(Imf::envmap(header));
    if (kind == int(Imf::ENVMAP_LATLONG)) return ImageProjection::LatLong;
    if (kind == int(Imf::ENVMAP_CUBE)) return ImageProjection::Cube;
    throw Error(
        fmt::format("{}: expected an envmap attribute of 0 (latlong) or 1 (cube), found {}", name, kind));
}

Image readPixels(Imf::InputFile& file, const Imath::Box2i& window, bool luminance) {
    Image image(window.max.x - window.min.x + 1, window.max.y - window.min.y + 1);
    Imf::FrameBuffer target;
    const auto add = [&](const char* channel, int component, double absent) {
        float* base = &image.pixels[0].x + component;
        target.insert(channel, Imf::Slice::Make(Imf::FLOAT, base, window, sizeof(vec4),
                                                sizeof(vec4) * size_t(image.width), 1, 1, absent));
    };
    add(luminance ? "Y" : "R", 0, 0);
    if (!luminance) {
        add("G", 1, 0);
        add("B", 2, 0);
    }
    add("A", 3, 1);
    file.setFrameBuffer(target);
    file.readPixels(window.min.y, window.max.y);
    if (luminance)
        for (vec4& pixel : image.pixels) pixel.y = pixel.z = pixel.x;
    return image;
}

} // namespace

bool isExr(std::span<const std::byte> bytes) {
    constexpr unsigned char kMagic[] = {0x76, 0x2f, 0x31, 0x01};
    return bytes.size() >= sizeof kMagic && std::memcmp(bytes.data(), kMagic, sizeof kMagic) == 0;
}

ImageFile decodeExr(std::span<const std::byte> bytes, const std::string& name) try {
    const auto [header, headerBytes] = readHeader(bytes, name);
    const bool isTiled = Imf::isTiled(versionOf(bytes));
    const Imath::Box2i window = header.dataWindow();
    const int64_t width = int64_t(window.max.x) - window.min.x + 1;
    const int64_t height = int64_t(window.max.y) - window.min.y + 1;
    checkImageSize(name, width, height, bytes.size());
    checkDensity(name, width, height, bytes.size());
    checkChunkSizes(header, isTiled, width, height, bytes.size(), name);
    const bool luminance = isLuminance(header.channels(), name);
    warnOfPrimaries(header, name);
    const ImageProjection projection = projectionOf(header, name);
    checkExrChunks(bytes, headerBytes, header, isTiled, name);
    MemoryReader reader(bytes, name);
    Imf::InputFile file(reader);
    if (!file.isComplete())
        throw Error(fmt::format("{}: damaged OpenEXR file: it lacks pixels; get the file again", name));
    return {readPixels(file, window, luminance), projection};
} catch (const Error&) {
    throw;
} catch (const std::bad_alloc&) { // not the file's fault
    throw;
} catch (const std::exception& failure) {
    throw Error(fmt::format("{}: damaged OpenEXR file: {}; get the file again", name, failure.what()));
}

std::vector<std::byte> encodeExr(const Image& image) try {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer source;
    const char* const channels[] = {"R", "G", "B", "A"};
    for (int c = 0; c < 4; c++) {
        header.channels().insert(channels[c], Imf::Channel(Imf::FLOAT));
        source.insert(channels[c], Imf::Slice::Make(Imf::FLOAT, &image.pixels[0].x + c, header.dataWindow(),
                                                    sizeof(vec4), sizeof(vec4) * size_t(image.width)));
    }
    MemoryWriter writer;
    {
        Imf::OutputFile file(writer, header);
        file.setFrameBuffer(source);
        file.writePixels(image.height);
    }
    return std::move(writer.bytes);
} catch (const Iex::ErrnoExc&) { // what the library says of its own streams in memory when one cannot grow
    throw std::bad_alloc();
}

} // namespace relume
