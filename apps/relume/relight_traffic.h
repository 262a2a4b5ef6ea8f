// How much memory relighting must touch: what its time is held against.
#pragma once

#include "engine/light/light_vector.h"
#include "engine/transport/transport.h"

namespace relume {

// Bytes of transport that a light makes relighting read at least, and of tuples that are written: columns
// that the light does not meet are not counted but for their index.
double relightBytes(const Transport& transport, const LightVector& light);

} // namespace relume
