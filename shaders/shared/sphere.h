// Structs, sizes and push constants of lit spheres: engine/render/lit_spheres.h.
#ifndef RELUME_SHADERS_SHARED_SPHERE_H
#define RELUME_SHADERS_SHARED_SPHERE_H
#include "shaders/shared/types.h"

RELUME_SHARED_BEGIN

// A sphere is a polar map about a view direction: rings of equal width in the angle from it, each divided
// into equal azimuths.
const uint kSphereRings = 48, kSphereAzimuths = 96;
// The largest azimuthal frequency of a kernel, and its largest harmonic of the view's azimuth. The lobes of
// brushed materials, seen along the normal, turn with the view: they need the harmonics of their own shape.
const uint kMostFrequencies = kSphereAzimuths / 2, kMostHarmonics = 12;

// The view directions for which spheres are made: corners of cells of equal angle on the faces of a cube.
const uint kGridCells = 6, kGridSide = kGridCells + 1, kGridNodes = 6 * kGridSide * kGridSide;

// The cube of light from which spheres are made: faces of kSphereCube² texels, with a border of one texel
// from their neighbors.
const uint kSphereCube = 32, kSphereCubeBordered = kSphereCube + 2;
// Cells along a side of a face; unshadowed tuples are summed over one light per cell.
const uint kTupleCells = 8, kTupleLights = 6 * kTupleCells * kTupleCells;
// Unshadowed tuples are polar maps of normals about +Y. Where frames do not follow from normals, there are
// maps for kTupleTurns equal turns about the normal, from the frame of tangentFrame() above the horizon and
// of lowerTangentFrame() below it. Each side has kTupleSideRings rings, one of them beyond the horizon.
const uint kTupleRings = 16, kTupleAzimuths = 32, kTupleTurns = 24, kTupleSideRings = kTupleRings / 2 + 1;
const uint kTurnedRows = 2 * kTupleTurns * kTupleSideRings; // rows of an image: [side][turn][ring]

struct SphereCubePush {
    uint faceSize; // F of the lighting cube
    uint isFill;   // 1: radiance is that of the fill; the whole light's cells have been made
};
RELUME_SHARED_SIZE(SphereCubePush, 8)

// Texels per light of a cell: its direction, and radiance · solid angle of the whole light and of its fill.
const uint kCellTexels = 3;

struct UnshadowedTuplesPush {
    uint mapping;    // of the light maps: DiskMapping
    uint terms;      // K
    uint isGray;     // ViewMapTexture::isGray
    uint firstImage; // the set's first image; it has three per four terms
    uint rows;       // of an image: kTupleRings or, if any set is turned, kTurnedRows
    uint isTurned;   // 1: for each of kTupleTurns turns
    uint fillImages; // number of images before those of the fill
};
RELUME_SHARED_SIZE(UnshadowedTuplesPush, 28)

// The layout of a kernel's spheres in the buffers between passes.
struct SpherePush {
    uint nodes;       // number of nodes whose spheres are made together
    uint frequencies; // M
    uint harmonics;   // H
};
RELUME_SHARED_SIZE(SpherePush, 12)

RELUME_SHARED_END

#endif
