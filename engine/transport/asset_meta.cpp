#include "engine/transport/asset_meta.h"

#include "engine/base/error.h"
#include "engine/chunk/byte_stream.h"
#include "engine/scene/factored_brdf.h"
#include "engine/transport/asset_check.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/core.h>
#include <map>

namespace relume {

namespace {

// Writes fields consecutively, as docs/asset_format.md lists them.
class FieldWriter {
  public:
    void flag(bool value) { mBytes.put(uint8_t(value)); }
    void whole(uint64_t value) { mBytes.put(uint32_t(value)); }
    void longWhole(uint64_t value) { mBytes.put(value); }
    void real(float value) { mBytes.put(std::bit_cast<uint32_t>(value)); }
    void number(double value) { mBytes.put(std::bit_cast<uint64_t>(value)); }
    void text(std::string_view value) {
        whole(value.size());
        mBytes.put(std::as_bytes(std::span(value)));
    }
    std::vector<std::byte> take() { return mBytes.take(); }

  private:
    ByteWriter mBytes;
};

// Reads fields. Throws an Error that names the field if a value is out of range.
class FieldReader {
  public:
    FieldReader(std::span<const std::byte> bytes, const std::string& where)
        : mBytes(bytes, where), mWhere(where) {}

    bool flag(const char* field) {
        const auto value = mBytes.get<uint8_t>();
        if (value > 1) fail(field, "0 or 1");
        return value == 1;
    }
    uint64_t whole(const char* field, uint64_t low, uint64_t high) {
        return inRange(field, mBytes.get<uint32_t>(), low, high);
    }
    int integer(const char* field, int low, int high) {
        return int(whole(field, uint64_t(low), uint64_t(high)));
    }
    uint64_t longWhole(const char* field, uint64_t low, uint64_t high) {
        return inRange(field, mBytes.get<uint64_t>(), low, high);
    }
    float real(const char* field) {
        const float value = std::bit_cast<float>(mBytes.get<uint32_t>());
        if (!std::isfinite(value)) fail(field, "a finite number");
        return value;
    }
    double number(const char* field) {
        const double value = std::bit_cast<double>(mBytes.get<uint64_t>());
        if (!std::isfinite(value)) fail(field, "a finite number");
        return value;
    }
    std::string text() {
        const auto bytes = mBytes.take(mBytes.get<uint32_t>());
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
    TransportLayout layout() { return readLayoutName(text(), mWhere); }
    size_t left() const { return mBytes.left(); }

    [[noreturn]] void fail(const char* field, const std::string& expected) const {
        throw Error(fmt::format("{}: {}: expected {}; the file is damaged", mWhere, field, expected));
    }

  private:
    uint64_t inRange(const char* field, uint64_t value, uint64_t low, uint64_t high) const {
        if (value < low || value > high)
            fail(field, fmt::format("a whole number of {} to {}, found {}", low, high, value));
        return value;
    }

    ByteReader mBytes;
    const std::string& mWhere;
};

// Maps a residual to the index of the first set that has it.
using ResidualOwners = std::map<const ResidualSet*, uint32_t>;

void write(FieldWriter& out, const SphereKernel& kernel) {
    out.whole(uint64_t(kernel.frequencies));
    out.whole(uint64_t(kernel.harmonics));
}

void writeResidual(FieldWriter& out, const MaterialSet& set, uint32_t number, ResidualOwners& owners) {
    out.flag(set.residual != nullptr);
    if (!set.residual) return;
    const auto [owner, isFirst] = owners.emplace(set.residual.get(), number);
    out.whole(owner->second);
    if (!isFirst) return;
    for (const auto& kernel : set.residual->layers) write(out, *kernel);
}

// Fields of a set's transport that META has besides the chunks.
void writeLayout(FieldWriter&, const SparseTransport&) {}
void readLayout(FieldReader&, SparseTransport&) {}

void writeLayout(FieldWriter& out, const BasisTransport& bases) {
    out.whole(bases.kinds.size());
    for (const auto& [term, color] : bases.kinds) {
        out.whole(term);
        for (int channel = 0; channel < 3; channel++) out.real(color[channel]);
    }
}

void readLayout(FieldReader& in, BasisTransport& bases) {
    const uint64_t kinds = in.whole("kinds", 0, 3 * kMostTerms);
    for (uint64_t i = 0; i < kinds; i++) {
        const auto term = uint32_t(in.integer("term", 0, kMostTerms - 1));
        const float red = in.real("red"), green = in.real("green"), blue = in.real("blue");
        bases.kinds.push_back({term, {red, green, blue}});
    }
}

void writeSet(FieldWriter& out, const MaterialSet& set, uint64_t entries) {
    out.whole(set.materials.size());
    for (const AssetMaterial& material : set.materials) {
        out.text(material.name);
        out.text(material.description);
        out.whole(uint64_t(material.layer));
        out.flag(material.hasBase);
    }
    out.whole(uint64_t(set.brdf.terms));
    out.whole(uint64_t(set.brdf.layers));
    out.whole(uint64_t(set.brdf.size));
    out.text(diskMappingName(set.brdf.mapping));
    out.text(layoutName(layoutOf(set.transport)));
    out.longWhole(entries);
    std::visit([&](const auto& layout) { writeLayout(out, layout); }, set.transport);
}

void writeTexture(FieldWriter& out, const std::optional<Texture>& texture) {
    out.flag(texture.has_value());
    if (!texture) return;
    out.whole(uint64_t(texture->width));
    out.whole(uint64_t(texture->height));
    out.flag(texture->srgb);
}

// Returns whether a part has fields that were added within version 3.
bool isDetailed(const AssetPart& part) { return part.tintedByColors || part.detail.isAny(); }

void writeDetail(FieldWriter& out, const AssetPart& part) {
    out.flag(part.tintedByColors);
    writeTexture(out, part.detail.normalMap);
    if (part.detail.normalMap) out.real(part.detail.normalScale);
    for (int channel = 0; channel < 3; channel++) out.real(part.detail.emission[channel]);
    writeTexture(out, part.detail.emissionMap);
}

void writePart(FieldWriter& out, const AssetPart& part, const AssetPartSizes& sizes) {
    out.text(part.name);
    out.whole(sizes.vertices);
    out.whole(sizes.triangles);
    out.flag(sizes.uvs > 0);
    out.flag(sizes.colors > 0);
    out.flag(sizes.tangents > 0);
    out.flag(part.paintedByColors);
    writeTexture(out, part.baseColor);
    writeTexture(out, part.materialMap);
    out.whole(part.sets.size());
}

void writeOptional(FieldWriter& out, const std::optional<double>& value) {
    out.flag(value.has_value());
    if (value) out.number(*value);
}

std::optional<double> readOptional(FieldReader& in, const char* field) {
    return in.flag(field) ? std::optional(in.number(field)) : std::nullopt;
}

std::optional<Texture> readTexture(FieldReader& in, const char* field) {
    if (!in.flag(field)) return std::nullopt;
    Texture texture;
    texture.width = in.integer(field, 1, kLongestTextureSide);
    texture.height = in.integer(field, 1, kLongestTextureSide);
    texture.srgb = in.flag(field);
    return texture;
}

void readDetail(FieldReader& in, AssetPart& part) {
    part.tintedByColors = in.flag("tintedByColors");
    part.detail.normalMap = readTexture(in, "normalMap");
    if (part.detail.normalMap) part.detail.normalScale = in.real("normalScale");
    for (int channel = 0; channel < 3; channel++) part.detail.emission[channel] = in.real("emission");
    part.detail.emissionMap = readTexture(in, "emissionMap");
}

// Reads a residual. `before` has those of all earlier sets, of any part. Kernels have no values yet.
void readResidual(FieldReader& in, std::span<const std::shared_ptr<const ResidualSet>> before,
                  MaterialSet& set) {
    if (!in.flag("residual")) return;
    const uint64_t owner = in.whole("residual", 0, before.size());
    if (owner < before.size()) {
        set.residual = before[owner];
        if (!set.residual) in.fail("residual", "a set that has one");
        return;
    }
    const auto residual = std::make_shared<ResidualSet>();
    for (int layer = 0; layer < set.brdf.layers; layer++) {
        const auto kernel = std::make_shared<SphereKernel>();
        kernel->frequencies = in.integer("frequencies", 0, shared::kMostFrequencies);
        kernel->harmonics = in.integer("harmonics", 0, shared::kMostHarmonics);
        residual->layers.push_back(kernel);
    }
    set.residual = residual;
}

MaterialSet readSet(FieldReader& in, uint64_t vertices, std::vector<uint64_t>& setEntries) {
    MaterialSet set;
    const uint64_t materials = in.whole("materials", 1, in.left());
    for (uint64_t i = 0; i < materials; i++) {
        AssetMaterial& material = set.materials.emplace_back();
        material.name = in.text();
        material.description = in.text();
        material.layer = in.integer("layer", 0, kLargestLayers);
        material.hasBase = in.flag("base");
    }
    set.brdf.terms = in.integer("terms", 1, kMostTerms);
    set.brdf.layers = in.integer("layers", 1, kLargestLayers);
    set.brdf.size = in.integer("mapSize", kSmallestMap, kLargestMap);
    const auto mapping = diskMappingFromName(in.text());
    if (!mapping) in.fail("mapping", "one that this program knows");
    set.brdf.mapping = *mapping;
    set.transport = emptyTransport(in.layout(), uint32_t(vertices), uint32_t(set.brdf.terms));
    setEntries.push_back(in.longWhole("entries", 0, kMostMetaEntries));
    std::visit([&](auto& own) { readLayout(in, own); }, set.transport);
    return set;
}

} // namespace

AssetSizes sizesOf(const Asset& asset, std::span<const uint64_t> setEntries) {
    AssetSizes sizes{asset.occluder.vertexCount(), asset.occluder.triangleCount(), {}, {}};
    for (const AssetPart& part : asset.parts)
        sizes.parts.push_back({part.mesh.vertexCount(), part.mesh.triangleCount(), part.mesh.uvs.size(),
                               part.mesh.colors.size(), part.mesh.tangents.size()});
    sizes.setEntries.assign(setEntries.begin(), setEntries.end());
    return sizes;
}

std::vector<std::byte> encodeMeta(const Asset& asset, const AssetSizes& sizes,
                                  const std::string& visibilityKey) {
    FieldWriter out;
    out.whole(uint64_t(asset.faceSize));
    out.whole(uint64_t(asset.visibilitySize));
    out.whole(uint64_t(asset.coefficients));
    out.whole(uint64_t(asset.transportSamples));
    out.real(asset.visibilityOffset);
    out.real(asset.quantizationError);
    out.real(asset.truncationError);
    out.flag(asset.layout.has_value());
    if (asset.layout) {
        writeOptional(out, asset.layout->wantedBytes);
        writeOptional(out, asset.layout->wantedError);
        out.number(asset.layout->error);
    }
    out.whole(sizes.occluderVertices);
    out.whole(sizes.occluderTriangles);
    out.whole(asset.parts.size());
    uint32_t setNumber = 0;
    ResidualOwners owners;
    for (size_t number = 0; number < asset.parts.size(); number++) {
        writePart(out, asset.parts[number], sizes.parts[number]);
        for (const MaterialSet& set : asset.parts[number].sets) {
            writeSet(out, set, sizes.setEntries[setNumber]);
            writeResidual(out, set, setNumber, owners);
            setNumber++;
        }
    }
    const Provenance& provenance = asset.provenance;
    for (const std::string& text :
         {provenance.program, provenance.device, provenance.options, provenance.inputs})
        out.text(text);
    out.flag(provenance.bakedShare.has_value());
    if (provenance.bakedShare) out.real(*provenance.bakedShare);
    out.text(visibilityKey);
    const bool hasDetails = std::ranges::any_of(asset.parts, isDetailed);
    if (asset.bounces > 0 || hasDetails) out.whole(uint64_t(asset.bounces));
    if (hasDetails)
        for (const AssetPart& part : asset.parts) writeDetail(out, part);
    std::vector<std::byte> bytes = out.take();
    if (bytes.size() > kLargestMeta)
        throw Error(fmt::format(
            "names, materials and provenance take {} bytes, more than the {} that a bake can hold; use "
            "fewer or shorter ones",
            bytes.size(), kLargestMeta));
    return bytes;
}

AssetMeta decodeMeta(std::span<const std::byte> bytes, const std::string& name) {
    const std::string where = name + ": chunk META";
    FieldReader in(bytes, where);
    AssetMeta meta;
    Asset& asset = meta.asset;
    asset.faceSize = in.integer("faceSize", kSmallestFace, kLargestFace);
    asset.visibilitySize = in.integer("visibilitySize", kSmallestVisibility, kLargestVisibility);
    asset.coefficients = in.integer("coefficients", 1, 6 * kLargestFace * kLargestFace);
    asset.transportSamples = in.integer("transportSamples", 1, kLargestVisibility * kLargestVisibility);
    asset.visibilityOffset = in.real("visibilityOffset");
    asset.quantizationError = in.real("quantizationError");
    asset.truncationError = in.real("truncationError");
    if (in.flag("layout")) {
        LayoutRecord& layout = asset.layout.emplace();
        layout.wantedBytes = readOptional(in, "wantedBytes");
        layout.wantedError = readOptional(in, "wantedError");
        layout.error = in.number("error");
    }
    meta.sizes.occluderVertices = in.whole("occluder vertices", 0, kMostMetaCount);
    meta.sizes.occluderTriangles = in.whole("occluder triangles", 0, kMostMetaCount);
    const uint64_t parts = in.whole("parts", 1, in.left());
    std::vector<std::shared_ptr<const ResidualSet>> residuals; // of the sets so far
    for (uint64_t number = 0; number < parts; number++) {
        AssetPart& part = asset.parts.emplace_back();
        AssetPartSizes& sizes = meta.sizes.parts.emplace_back();
        part.name = in.text();
        sizes.vertices = in.whole("vertices", 1, kMostMetaCount);
        sizes.triangles = in.whole("triangles", 1, kMostMetaCount);
        sizes.uvs = in.flag("uvs") ? sizes.vertices : 0;
        sizes.colors = in.flag("colors") ? sizes.vertices : 0;
        sizes.tangents = in.flag("tangents") ? sizes.vertices : 0;
        part.paintedByColors = in.flag("paintedByColors");
        part.baseColor = readTexture(in, "baseColor");
        part.materialMap = readTexture(in, "materialMap");
        const uint64_t sets = in.whole("sets", 1, in.left());
        for (uint64_t i = 0; i < sets; i++) {
            part.sets.push_back(readSet(in, sizes.vertices, meta.sizes.setEntries));
            readResidual(in, residuals, part.sets.back());
            residuals.push_back(part.sets.back().residual);
        }
    }
    Provenance& provenance = asset.provenance;
    for (std::string* text :
         {&provenance.program, &provenance.device, &provenance.options, &provenance.inputs})
        *text = in.text();
    if (in.flag("bakedShare")) provenance.bakedShare = in.real("bakedShare");
    meta.visibilityKey = in.text();
    if (!meta.visibilityKey.empty() &&
        (meta.visibilityKey.size() != kVisibilityKeyDigits ||
         meta.visibilityKey.find_first_not_of("0123456789abcdef") != std::string::npos))
        in.fail("visibilityKey", fmt::format("{} hexadecimal digits", kVisibilityKeyDigits));
    if (in.left() > 0) {
        asset.bounces = in.integer("bounces", 0, kMostBounces);
        if (in.left() > 0) {
            for (AssetPart& part : asset.parts) readDetail(in, part);
            if (std::ranges::none_of(asset.parts, isDetailed)) in.fail("details", "some of a part, or none");
        } else if (asset.bounces == 0) {
            in.fail("bounces", "more than 0, or details");
        }
    }
    if (in.left() > 0) in.fail("end", "no more bytes");
    return meta;
}

} // namespace relume
