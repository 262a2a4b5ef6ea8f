// The chunks of every layout's transport. Each layout has these functions, which std::visit finds by type:
//
// - blockVertices(layout, coefficients, most terms of a set): returns the vertices of a block (asset.h);
// - addTransport, readTransport: write all of a set's transport to a file, and read it;
// - chunkSizes: returns the sizes in bytes that the chunk of one block can have;
// - memoryBytes: returns the bytes that the transport of a block's chunk takes in memory;
// - entriesOf: returns the number of entries (entriesOf() in transport.h) in a block's chunk;
// - checkChunk: throws Error if a reader of the whole file would refuse a block's chunk;
// - checkLayout: throws Error if a set's data about its transport, chunks aside, are invalid.
//
// `layout` is a set's transport, which may be empty.
#pragma once

#include "engine/transport/bases/basis_chunk.h"
#include "engine/transport/rows/rows_chunk.h"
