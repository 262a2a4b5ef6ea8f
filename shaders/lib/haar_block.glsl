// How a row of coefficients is cut into blocks, two Haar levels at a time: 4×4 values become 15 details and an
// average, a value of the next, four times coarser stage. A face of F² texels is (F / 4)² blocks, and so on to
// its last block, of 2² values where F = 32, which keeps its average as well.
#ifndef RELUME_LIB_HAAR_BLOCK_GLSL
#define RELUME_LIB_HAAR_BLOCK_GLSL

// Blocks of a row are numbered stage by stage from the finest, face by face, line by line. Here, how many there
// are of the first stage, the second, and of all three.
#define HAAR_FINE_BLOCKS(faceSize) (6 * ((faceSize) / 4) * ((faceSize) / 4))
#define HAAR_COARSE_BLOCKS(faceSize) (6 * ((faceSize) / 16) * ((faceSize) / 16))
#define HAAR_BLOCKS(faceSize) (HAAR_FINE_BLOCKS(faceSize) + HAAR_COARSE_BLOCKS(faceSize) + 6)

// Coefficient `slot` of a block, as a place on its face: `width` is the blocks a side of its stage. Slots 0 to
// 11 are the details of its four quads, 12 to 14 those of the block, 15 its average.
uvec2 haarSlotPlace(uvec2 block, uint slot, uint width) {
    const uint detail = slot < 12 ? slot % 3 : slot - 12;
    const uvec2 offset = detail == 3 ? uvec2(0) : uvec2(detail != 1, detail != 0);
    if (slot < 12) return block * 2 + uvec2(slot / 3 % 2, slot / 6) + offset * 2 * width;
    return block + offset * width;
}

#endif
