#version 460
// Blended by maximum over a part whose terms took several draws: what their sum left negative becomes zero.
layout(location = 0) out vec4 color;

void main() { color = vec4(0); }
