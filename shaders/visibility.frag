#version 460
// A covered texel is blocked.
layout(location = 0) out uint blocked;

void main() { blocked = 1; }
