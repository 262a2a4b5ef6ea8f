#version 460
// Which triangle is seen.
layout(location = 0) flat in uint surface;
layout(location = 0) out uint seen;

void main() { seen = surface; }
