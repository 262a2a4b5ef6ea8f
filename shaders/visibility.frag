#version 460
// Marks a covered texel as blocked.
layout(location = 0) out uint blocked;

void main() { blocked = 1; }
