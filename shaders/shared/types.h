// GLSL's types in C++, so that one header serves both. Structs shared with shaders use scalar layout, which
// has the same offsets as C++.
#ifndef RELUME_SHADERS_SHARED_TYPES_H
#define RELUME_SHADERS_SHARED_TYPES_H

#ifdef __cplusplus
#include "engine/math/vector.h"
namespace relume::shared {
using uint = uint32_t;
}
#define RELUME_SHARED_BEGIN namespace relume::shared {
#define RELUME_SHARED_END }
#define RELUME_SHARED_SIZE(type, bytes) static_assert(sizeof(type) == bytes);
#else
#define RELUME_SHARED_BEGIN
#define RELUME_SHARED_END
#define RELUME_SHARED_SIZE(type, bytes)
#endif

#endif
