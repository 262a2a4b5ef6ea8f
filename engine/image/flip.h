// ꟻLIP: the difference that a person sees when two images alternate on a display (Andersson, Nilsson,
// Akenine-Möller, Oskarsson, Åström, Fairchild: FLIP, A Difference Evaluator for Alternating Images, High
// Performance Graphics 2020).
#pragma once

#include "engine/image/image.h"

namespace relume {

// Returns the mean over the pixels of the LDR-ꟻLIP error, in [0, 1], seen at 67 pixels per degree (a 0.7 m
// wide 4K display from 0.7 m). Symmetric. Both images hold sRGB display values in [0, 1] and have the same
// size; ignores alpha.
double flipError(const Image& a, const Image& b);

} // namespace relume
