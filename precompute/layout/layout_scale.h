// Parameters that all clusters of a bake share, so that each can be encoded independently.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/layout/layout_options.h"

#include <span>
#include <vector>

namespace relume {

// Version of everything besides a bake's inputs and options that determines the bytes of bases: entries of
// the rows that they are made from, choice of the sample, derivation of the scale, encoding of clusters.
// Raised with every change to these, so that blocks of different programs never meet in one bake.
constexpr uint32_t kLayoutEncoderVersion = 5;

struct LayoutScale {
    std::vector<float> norms; // per set, over all parts: normalization by transportNorm()
    double lambda = 0;        // Lagrange multiplier: error per byte (basis_analysis.h)

    bool operator==(const LayoutScale&) const = default;
};

struct SetSample; // precompute/transport/layout_work.h

// Returns the scale at which bases come closest to what `options` ask for, according to the samples; sets
// without a sample are taken to be like the others. A budget is for the asset's `vertices`. The scale is the
// same on every machine.
LayoutScale findScale(std::span<const SetSample> samples, int faceSize, uint64_t vertices,
                      const LayoutOptions& options);

// Makes Eigen's sums independent of the machine, whose cache sizes decide how it blocks products. Affects all
// later products of the process; must not be called during one.
void makeSumsDeterministic();

// Returns the default error of an asset in bases, for options that name none.
double defaultLayoutError(const Asset& asset);

// Returns the record of a layout that an asset keeps.
LayoutRecord recordOf(const LayoutOptions& options, double error);

constexpr const char* kTooLarge =
    "transport is too large for numbers of 32 bits; bake it again, with a material of less gain";

} // namespace relume
