// The chunks of every layout's transport. A layout has these functions, which std::visit finds by its type:
//
// - blockVertices(layout, coefficients, most terms of a set): vertices of a block (asset.h);
// - addTransport, readTransport: all of a set's transport, into a file and out of it;
// - chunkSizes, memoryBytes, entriesOf, checkChunk: of the chunk of one block, how many bytes it can have,
// how
//   many its transport takes in memory, how many entries (entriesOf() of transport.h) that is, and whether a
//   reader of the whole would refuse it (throws Error);
// - checkLayout: of what a set says of its transport besides chunks. Throws Error.
//
// `layout` is a set's transport, perhaps without any in it.
#pragma once

#include "engine/transport/bases/basis_chunk.h"
#include "engine/transport/rows/rows_chunk.h"
