// A bake in memory: everything needed to relight and draw it, and how it was made. File format:
// docs/asset_format.md.
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

// A material that can be bound to a part.
struct AssetMaterial {
    std::string name;        // by which it is chosen; unique within its part
    std::string description; // the BRDF: a JSON object {"model": …, parameters…}, as text
    // The layer of the set's view maps: all of f; or, if `hasBase`, the part of f that the base color does
    // not multiply, with the part that it does multiply in layer + 1.
    int layer = 0;
    bool hasBase = false;

    int layers() const { return hasBase ? 2 : 1; }
};

// Materials that were factored jointly: they share light maps, and thus the transport baked with these.
struct MaterialSet {
    std::vector<AssetMaterial> materials;
    FactoredBrdf brdf;
    Transport transport; // terms == brdf.terms, vertices == the part's
    // Null if the K terms suffice, as for diffuse materials. Sets with the same light maps and materials
    // share it, but parts with tangents do not share with parts without: their unshadowed tuples are laid out
    // differently.
    std::shared_ptr<const ResidualSet> residual = nullptr;
    // The share of direct light in what each term of a vertex gathers from even light; the rest has bounced.
    // A vertex has shareWords() words of four terms each, a byte per term in 255ths, the first in the lowest.
    // It is empty, and all shares are 1, without bounces, without a residual of nonnegative terms, and in
    // files that earlier versions wrote.
    std::vector<uint32_t> directShares = {};

    // Returns the number of words in `directShares` per vertex.
    size_t shareWords() const { return (size_t(brdf.terms) + 3) / 4; }
    // Returns a share, 0 to 1.
    float directShare(size_t vertex, size_t term) const {
        if (directShares.empty()) return 1;
        return float(directShares[vertex * shareWords() + term / 4] >> (8 * (term % 4)) & 0xff) / 255;
    }
};

// One surface of the scene. Vertices are in bake order (precompute/bake/vertex_order.h).
struct AssetPart {
    std::string name;
    Mesh mesh;
    std::vector<MaterialSet> sets;                   // at least one
    std::optional<Texture> baseColor = std::nullopt; // sampled at mesh.uvs
    // If the part is painted, the weights of a set's first four materials: an image sampled at mesh.uvs, or
    // mesh.colors.
    std::optional<Texture> materialMap = std::nullopt;
    bool paintedByColors = false;
    bool tintedByColors = false; // mesh.colors multiply materials' bases, and baseColor if there is one
    SurfaceDetail detail = {};

    // Returns whether a texture or vertex colors multiply the base of materials.
    bool hasBaseColor() const { return baseColor || tintedByColors; }
    bool isPainted() const { return materialMap || paintedByColors; }
};

// Returns the number of terms of all sets of a part.
int termCount(const AssetPart& part);

// How an asset was made. It is stored in the file, but relighting needs none of it.
struct Provenance {
    std::string program; // "relume 0.1.0"
    std::string device;  // name and driver of the device that baked it
    std::string options; // JSON object: every bake option that affects the bytes
    std::string inputs;  // JSON array: {"name", "file", "hash"} of every input file
    // The share of vertices that are baked in a preview; the rows of the others are interpolated.
    std::optional<float> bakedShare = std::nullopt;
};

// How transport was compressed from rows: the bytes or the error that was asked for, one of both, and the
// error that resulted. Errors are root mean squares, weighted by the spectrum of light, relative to a set's
// normalization, the deviation of its vertices from their mean (precompute/transport/norm_sum.h).
struct LayoutRecord {
    std::optional<double> wantedBytes; // per vertex, in memory
    std::optional<double> wantedError;
    double error = 0; // against the rows as baked; estimated if made from another compressed layout
};

// A complete bake.
struct Asset {
    int faceSize = 64;           // F: side of a face of the lighting cube, in texels
    int visibilitySize = 256;    // side of a face of the visibility cube, in texels
    int coefficients = 96;       // N: most entries of a row; see also rowEntries()
    int transportSamples = 1;    // light map evaluations per lighting texel
    int bounces = 0;             // reflections between surfaces that transport includes, before the last
    float visibilityOffset = 0;  // distance by which a vertex was lifted along its normal
    float quantizationError = 0; // relative L2 over all rows, as measured during the bake
    float truncationError = 0;   // relative L2 over all rows, of keeping N entries only, as measured
    std::optional<LayoutRecord> layout = std::nullopt; // none: rows as baked, or in files from before it
    Mesh occluder;                                     // positions and triangles that cast the shadows
    std::vector<AssetPart> parts;
    Provenance provenance;
};

// Bases of one term are made from rows of so many times N entries. Neighbors leave out the same coefficients,
// which with N makes whole walls too dark or bright; and one longer row costs little beside those of a glossy
// set (docs/layouts.md).
constexpr int kOneTermEntries = 4;

// Returns the most row entries, N or more as above, from which a bake makes a set's transport. Bases that
// were converted from rows, or baked before this rule, were made from N.
int rowEntries(const Asset& asset, const MaterialSet& set);
// Returns their number in the rows of all sets of a vertex.
uint64_t rowEntries(const Asset& asset, const AssetPart& part);

// Returns the number of vertices of all parts.
uint64_t vertexCount(const Asset& asset);

Bounds boundsOf(const Asset& asset);
// Returns the bounds of all parts except the ground, which would push the object off the center of an image.
Bounds objectBounds(const Asset& asset);

// Returns the number of vertices of a block, which is baked, stored in a checkpoint and written as a run: for
// bases a cluster, for rows see rows_chunk.h.
uint32_t blockVertices(const Asset& asset);

// Returns the number of vertices of a run of kept visibility: a block or a part of one.
uint32_t visibilityRunVertices(const Asset& asset);

// Returns the angular radius, in radians, of the smallest lamp that shows no patches when it is the only
// light. Compression rounds shadows off, and the smaller the lamp, the more this shows (docs/errors.md).
float smallestLampRadius(const Asset& asset);

// Returns the contents of the asset's file. The same asset gives the same bytes.
std::vector<std::byte> encodeAsset(const Asset& asset);

// Returns the asset in `bytes`; `name` names them in errors. Throws Error if they are truncated, corrupt,
// absurd, inconsistent or of another version.
Asset decodeAsset(std::span<const std::byte> bytes, const std::string& name);

void writeAsset(const std::filesystem::path& path, const Asset& asset); // whole or not at all
Asset readAsset(const std::filesystem::path& path);

} // namespace relume
