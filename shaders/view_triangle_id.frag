#version 460
// Writes the triangle id to the visibility buffer.
layout(location = 0) flat in uint triangleId;
layout(location = 0) out uint seen;

void main() { seen = triangleId; }
