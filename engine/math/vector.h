// GLM's vectors under the project's names.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace relume {

using glm::ivec2;
using glm::ivec3;
using glm::mat3;
using glm::mat4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uvec3 = glm::u32vec3;

constexpr float kPi = 3.14159265358979323846f;

} // namespace relume
