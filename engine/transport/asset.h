// A bake: everything needed to relight, draw and explain itself. File format: docs/asset_format.md.
#pragma once

#include "engine/scene/factored_brdf.h"
#include "engine/scene/mesh.h"
#include "engine/scene/residual.h"
#include "engine/scene/surface_detail.h"
#include "engine/transport/transport.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace relume {

// A BRDF that a part can binding.
struct AssetMaterial {
    std::string name;        // As it is chosen by; unique within its part
    std::string description; // The BRDF: a JSON object {"model": …, parameters…}, as text.
    // Of the set's view maps: all of f; or, if `hasBase`, f without what the part's base color texture
    // multiplies, and that in layer + 1.
    int layer = 0;
    bool hasBase = false;

    int layers() const { return hasBase ? 2 : 1; }
};

// Materials that were factored jointly: they share light maps, and so the transport baked from these.
struct MaterialSet {
    std::vector<AssetMaterial> materials;
    FactoredBrdf brdf;
    Transport transport; // terms == brdf.terms, vertices == the part's
    // Null where the K terms are the BRDF, as of diffuse materials. Sets of the same light maps and materials
    // share it, but those of parts with tangents with no others: their unshadowed tuples are laid out
    // differently.
    std::shared_ptr<const ResidualSet> residual = nullptr;
};

// One surface of the scene. Vertices are in bake order (precompute/bake/vertex_order.h).
struct AssetPart {
    std::string name;
    Mesh mesh;
    std::vector<MaterialSet> sets;                   // at least one
    std::optional<Texture> baseColor = std::nullopt; // By mesh.uvs
    // Weights of a set's first four materials, where they are painted: by mesh.uvs, or mesh.colors
    // themselves.
    std::optional<Texture> materialMap = std::nullopt;
    bool paintedByColors = false;
    bool tintedByColors = false; // mesh.colors multiply materials' bases, and baseColor where there is one
    SurfaceDetail detail = {};

    // Returns whether something multiplies the base of materials.
    bool hasBaseColor() const { return baseColor || tintedByColors; }
    bool isPainted() const { return materialMap || paintedByColors; }
};

// How it was made. All of it goes into the file, none of it is needed to relight.
struct Provenance {
    std::string program; // "relume 0.1.0"
    std::string device;  // Name and driver of the device that baked it
    std::string options; // JSON object: every bake option that decides the bytes
    std::string inputs;  // JSON array: {"name", "file", "hash"} of every input file
    // Of a preview: the share of the vertices that are baked. The rows of the others are interpolated.
    std::optional<float> bakedShare = std::nullopt;
};

// How transport that is not in rows was cut down to its layout: what was asked for, one of both, and what
// came of it. Errors are as light weighs them, root mean square, relative to how far a set's vertices are
// from their mean (precompute/transport/unit_sum.h).
struct LayoutRecord {
    std::optional<double> wantedBytes; // per vertex, in memory
    std::optional<double> wantedError;
    double error = 0; // against the rows as baked; estimated where layouts were made of layouts
};

struct Asset {
    int faceSize = 64;           // F: side of a face of the lighting cube
    int visibilitySize = 256;    // side of a face of the visibility cube
    int coefficients = 96;       // N: most entries of a row
    int transportSamples = 1;    // light-map evaluations per lighting texel
    int bounces = 0;             // reflections between surfaces that the transport has, besides the last
    float visibilityOffset = 0;  // distance a vertex was lifted along its normal
    float quantizationError = 0; // relative L2 over all rows, as measured during the bake
    float truncationError = 0;   // relative L2 over all rows lost by keeping N, as measured during the bake
    std::optional<LayoutRecord> layout = std::nullopt; // none: rows as baked, or of before this was kept
    Mesh occluder;                                     // Positions and triangles that cast the shadows
    std::vector<AssetPart> parts;
    Provenance provenance;
};

Bounds boundsOf(const Asset& asset);
// Of everything but a ground, which would push the object out of the picture's middle.
Bounds objectBounds(const Asset& asset);

// Returns the number of vertices of a block, which is baked, kept in a checkpoint and written as a run: with
// bases those of a cluster, with rows as many as rows_chunk.h says.
uint32_t blockVertices(const Asset& asset);

// Vertices of a run of kept visibility: a block, or a part of it.
uint32_t visibilityRunVertices(const Asset& asset);

// Returns the angular radius, in radians, of the smallest lamp that is shown without patches where all else
// is dark: storage rounds shadows off, and the smaller a lamp, the more of it is seen (docs/errors.md,
// measured).
float smallestLampRadius(const Asset& asset);

// Bytes of the file. The same asset gives the same bytes.
std::vector<std::byte> encodeAsset(const Asset& asset);

// The asset in `bytes`; `name` stands for them in errors. Throws Error for anything that does not check out:
// truncated, corrupt, absurd, inconsistent, a later version.
Asset decodeAsset(std::span<const std::byte> bytes, const std::string& name);

void writeAsset(const std::filesystem::path& path, const Asset& asset); // whole or not at all
Asset readAsset(const std::filesystem::path& path);

} // namespace relume
