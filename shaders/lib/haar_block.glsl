// The division of a row of coefficients into blocks, by two Haar levels at a time: 4×4 values become 15 details and
// an average, which is a value of the next, four times coarser stage. A face of F² texels has (F / 4)² blocks, and so
// on to its last block, of 2² values if F = 32.
//
// In memory a row is a sequence of blocks, each of 16 slots of three floats, r, g, b: the details of its four quads
// (0 to 11), those of the block (12 to 14), and its average (15, which is a coefficient in a face's last block only).
// In blocks of zeros only the average is written, and in blocks of 2² values no details of quads. Each block also has
// a summary, which selection reads first: the largest squared magnitude of a coefficient, and their sum.
// C++ twin: haarSlot() in engine/math/haar.h.
#ifndef RELUME_LIB_HAAR_BLOCK_GLSL
#define RELUME_LIB_HAAR_BLOCK_GLSL

// The number of blocks of a row: in the first stage, in the second, and in all three. Blocks are numbered stage by
// stage from the finest, face by face, line by line.
#define HAAR_FINE_BLOCKS(faceSize) (6 * ((faceSize) / 4) * ((faceSize) / 4))
#define HAAR_COARSE_BLOCKS(faceSize) (6 * ((faceSize) / 16) * ((faceSize) / 16))
#define HAAR_BLOCKS(faceSize) (HAAR_FINE_BLOCKS(faceSize) + HAAR_COARSE_BLOCKS(faceSize) + 6)

// Returns the slots of a block that hold coefficients, a bit each.
uint haarCoefficientSlots(uint block, uint faceSize) {
    const bool isLast = block >= HAAR_FINE_BLOCKS(faceSize) + HAAR_COARSE_BLOCKS(faceSize);
    return !isLast ? 0x7fff : faceSize == 32 ? 0xf000 : 0xffff;
}

// Returns the index, face · F² + y · F + x, of the coefficient in a slot of a block.
uint haarCoefficient(uint block, uint slot, uint faceSize) {
    const uint coarse = HAAR_FINE_BLOCKS(faceSize), last = coarse + HAAR_COARSE_BLOCKS(faceSize);
    const uint width = block < coarse ? faceSize / 4 : block < last ? faceSize / 16 : 1; // blocks a side
    const uint inStage = block - (block < coarse ? 0 : block < last ? coarse : last);
    const uint face = inStage / (width * width), inFace = inStage % (width * width);
    const uvec2 at = uvec2(inFace % width, inFace / width);
    const uint detail = slot < 12 ? slot % 3 : slot - 12;
    const uvec2 offset = detail == 3 ? uvec2(0) : uvec2(detail != 1, detail != 0);
    const uvec2 place =
        slot < 12 ? at * 2 + uvec2(slot / 3 % 2, slot / 6) + offset * 2 * width : at + offset * width;
    return (face * faceSize + place.y) * faceSize + place.x;
}

// Returns where a coefficient is stored: 16 · block + slot.
uint haarSlot(uint coefficient, uint faceSize) {
    const uint face = coefficient / (faceSize * faceSize);
    const uvec2 place = uvec2(coefficient % faceSize, coefficient / faceSize % faceSize);
    const uint widest = max(place.x, place.y);
    const uint level = widest == 0 ? 0 : 1u << findMSB(widest); // a side, of the details it belongs to
    const uint width = level >= faceSize / 4 ? faceSize / 4 : level >= faceSize / 16 ? faceSize / 16 : 1;
    const uint first = width == faceSize / 4    ? 0
                       : width == faceSize / 16 ? HAAR_FINE_BLOCKS(faceSize)
                                                : HAAR_FINE_BLOCKS(faceSize) + HAAR_COARSE_BLOCKS(faceSize);
    const uint detail = uint(place.x >= level) + 2 * uint(place.y >= level) - 1;
    const uvec2 at = level == 0 ? uvec2(0) : place & (level - 1);
    const bool isQuad = level == 2 * width;
    const uvec2 block = isQuad ? at / 2 : at;
    const uint slot = isQuad ? 3 * (at.x % 2 + 2 * (at.y % 2)) + detail : level == 0 ? 15 : 12 + detail;
    return 16 * (first + (face * width + block.y) * width + block.x) + slot;
}

#endif
