// Checks of OpenEXR files that their library omits. Internal to the engine.
#pragma once

#include <Imath/ImathBox.h>
#include <OpenEXR/ImfForward.h>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace relume {

// Returns the number of bytes of a one-part file's header. Throws Error, in which `name` names the file,
// unless its attributes have sizes that fit their types.
size_t checkExrHeader(std::span<const std::byte> bytes, const std::string& name);

// Throws Error unless every chunk of a one-part file is where the library looks for it, and unpacks to all of
// its pixels or is of a compression of which the library checks that. `header` is the file's, of
// `headerBytes` bytes. The library must not rebuild the table of chunks: InputFile::isComplete().
void checkExrChunks(std::span<const std::byte> bytes, size_t headerBytes, const Imf::Header& header,
                    bool isTiled, const std::string& name);

// Returns whether a chunk in DWAA or DWAB has values for all pixels of `box`, coded as the library codes
// channels of their names and types, but for what the library itself refuses: DC coefficients and run lengths
// that unpack to less than the chunk says.
bool isDwaOf(std::span<const std::byte> packed, const Imf::ChannelList& channels, const Imath::Box2i& box);

// Decodes values in OpenEXR's Huffman coding, which `take` gets one by one. Returns whether there are
// `count`, in a code that the library reads as this does, and soon.
bool decodeExrHuffman(std::span<const std::byte> packed, uint64_t count,
                      const std::function<void(uint16_t)>& take);

// Returns whether a zlib stream inflates to `wanted` bytes. `take` gets them, and up to 16,384 more, in
// pieces of an even number of bytes but for the last.
bool isDeflatedFrom(std::span<const std::byte> packed, uint64_t wanted,
                    const std::function<void(std::span<const std::byte>)>& take = {});

// Returns the number of multiples of `step` from `first` to `last`: the pixels that a subsampled channel has.
uint32_t countMultiples(int step, int first, int last);

} // namespace relume
