// Structs, sizes and push constants of lit spheres: engine/render/lit_spheres.h.
#ifndef RELUME_SHADERS_SHARED_SPHERE_H
#define RELUME_SHADERS_SHARED_SPHERE_H
#include "shaders/shared/types.h"

RELUME_SHARED_BEGIN

// A sphere is a polar map about a view direction: rings of equal width in the angle from it, each of equal
// azimuths.
const uint kSphereRings = 48, kSphereAzimuths = 96;
// Largest azimuthal frequency, and largest harmonic of the view's azimuth, of a kernel.
const uint kMostFrequencies = kSphereAzimuths / 2, kMostHarmonics = 5;

// View directions that spheres are made for: corners of cells of equal angle on the faces of a cube.
const uint kGridCells = 6, kGridSide = kGridCells + 1, kGridNodes = 6 * kGridSide * kGridSide;

// The light that spheres are lit by: faces of kSphereCube² texels with a border of one from their neighbors.
const uint kSphereCube = 32, kSphereCubeBordered = kSphereCube + 2;
// Cells of a face that unshadowed tuples are summed over, a light each.
const uint kTupleCells = 8, kTupleLights = 6 * kTupleCells * kTupleCells;
// Unshadowed tuples are polar maps about +Y, of normals. Where frames do not follow from these, there is one
// for each of equal turns about the normal, from the frame of tangentFrame() above the horizon and of
// lowerTangentFrame() below: of kTupleSideRings either, one of them beyond it.
const uint kTupleRings = 16, kTupleAzimuths = 32, kTupleTurns = 24, kTupleSideRings = kTupleRings / 2 + 1;
const uint kTurnedRows = 2 * kTupleTurns * kTupleSideRings; // of an image: [side][turn][ring]

struct SphereCubePush {
    uint faceSize; // F, of the light cube
};
RELUME_SHARED_SIZE(SphereCubePush, 4)

struct UnshadowedTuplesPush {
    uint mapping;    // of the light maps: DiskMapping
    uint terms;      // K
    uint isGray;     // ViewMapTexture::isGray
    uint firstImage; // of the set's, three for each four terms
    uint rows;       // of an image: kTupleRings or, if any set is turned, kTurnedRows
    uint isTurned;   // 1: for each of kTupleTurns
};
RELUME_SHARED_SIZE(UnshadowedTuplesPush, 24)

// How a kernel's spheres lie in the buffers between passes.
struct SpherePush {
    uint nodes;       // whose spheres are made together
    uint frequencies; // M
    uint harmonics;   // H
};
RELUME_SHARED_SIZE(SpherePush, 12)

RELUME_SHARED_END

#endif
