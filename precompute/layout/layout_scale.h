// What all clusters of a bake share, so that each can be encoded by itself.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/layout/layout_options.h"

#include <span>
#include <vector>

namespace relume {

// The version of what decides the bytes of bases besides a bake's inputs and options: which sample is taken,
// how the scale follows from it, and how clusters are encoded with that. It is raised with every change of
// these, so that blocks of different programs never meet in one bake.
constexpr uint32_t kLayoutEncoderVersion = 2;

struct LayoutScale {
    std::vector<float> units; // per set, over all parts: transportUnit()
    double price = 0;         // of a byte (basis_analysis.h): what makes a cluster keep more or less

    bool operator==(const LayoutScale&) const = default;
};

struct SetSample; // precompute/transport/layout_work.h

// Finds the scale at which bases come closest to what `options` ask for, as the samples tell it; sets without
// any are taken to be as the others are. A budget is for the asset's `vertices`. The scale is the same on
// every machine.
LayoutScale findScale(std::span<const SetSample> samples, int faceSize, uint64_t vertices,
                      const LayoutOptions& options);

// Eigen cuts products by the sizes of the caches it finds, and sums would differ from one machine to another.
// For all that follow, in the whole process; not while others multiply.
void sumAlikeEverywhere();

// As an asset keeps it.
// Returns the error of transport that an asset in bases has where none is asked for.
double standardError(const Asset& asset);

LayoutRecord recordOf(const LayoutOptions& options, double error);

constexpr const char* kTooLarge =
    "transport is too large for numbers of 32 bits; bake it again, with a material of less gain";

} // namespace relume
