// The chunks of every layout's transport. A layout has these functions, which std::visit finds by its type:
//
// - blockVertices(layout, coefficients, most terms of a set): vertices of a block (asset.h);
// - addTransport, readTransport: all of a set's transport, into a file and out of it;
// - chunkSizes: how many bytes the chunk of one block can have;
// - memoryBytes: how many bytes the transport of a block's chunk takes in memory;
// - entriesOf: how many entries (entriesOf() of transport.h) a block's chunk holds;
// - checkChunk: throws Error where a reader of the whole would refuse a block's chunk;
// - checkLayout: throws Error where what a set says of its transport besides chunks is wrong.
//
// `layout` is a set's transport, perhaps without any in it.
#pragma once

#include "engine/transport/bases/basis_chunk.h"
#include "engine/transport/rows/rows_chunk.h"
