// The encoders of all layouts. A layout has these functions, which std::visit finds by its type:
//
// - prepareLayout: sets what follows from a set's BRDF, and from whether light bounces, before anything is
//   baked;
// - encodeBlock: encodes the rows of a block as its chunk;
// - findLambda: returns the Lagrange multiplier for encoding blocks, found from a sample of all rows
//   (layout_scale.h);
// - convertRows: converts the rows of all sets, in kConversionPasses passes; returns the squared error
//   relative to the sets' normalization.
//
// Rows, which are not compressed, have neither multiplier nor error. `layout` is transport without content.
#pragma once

#include "precompute/layout/bases/basis_encoder.h"
#include "precompute/layout/rows/rows_encoder.h"
