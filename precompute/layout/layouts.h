// How every layout is encoded. A layout has these functions, which std::visit finds by its type:
//
// - prepareLayout: sets what a set's BRDF, and whether light bounces, say of its transport, before any is
//   baked;
// - encodeBlock: rows of a block, as its chunk;
// - findPrice: what a block is to be encoded with, as a sample of all rows tells it (layout_scale.h);
// - convertRows: makes transport of all sets' rows, in kConversionPasses passes; its error, squared and in
//   units of the sets.
//
// Rows, which are not compressed, have neither price nor error. `layout` is transport without any in it.
#pragma once

#include "precompute/layout/bases/basis_encoder.h"
#include "precompute/layout/rows/rows_encoder.h"
