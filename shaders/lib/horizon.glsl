// The texels of a visibility cube that lie above a point's horizon.
#ifndef RELUME_LIB_HORIZON_GLSL
#define RELUME_LIB_HORIZON_GLSL

// Returns 32 bits; bit i says whether the center of texel x + i of row y, on a face of `size` texels, is above the
// horizon of `normal`, which is in face coordinates.
uint aboveHorizon(vec3 normal, uint x, uint y, uint size) {
    // The cosine is linear along a row, up to the direction's length: its sign needs no normalization.
    const float texelWidth = 2.0 / float(size);
    const float v = (float(y) + 0.5) * texelWidth - 1;
    const float rowStart = normal.y * v + normal.z + normal.x * ((float(x) + 0.5) * texelWidth - 1);
    const float rowStep = normal.x * texelWidth;
    uint above = 0;
    for (int i = 0; i < 32; i++) above |= uint(rowStart + rowStep * float(i) > 0) << i;
    return above;
}

#endif
