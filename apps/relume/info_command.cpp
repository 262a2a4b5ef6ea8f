#include "apps/relume/commands.h"
#include "engine/base/error.h"
#include "engine/import/asset_info.h"
#include "engine/transport/asset_arrays.h"
#include "engine/transport/kept_visibility.h"
#include "precompute/bake/bake_options.h"
#include "precompute/bake/baked_options.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <nlohmann/json.hpp>

namespace relume {

// Prints nested JSON as indented "key: value" lines.
static void printReadable(const nlohmann::ordered_json& value, int depth) {
    for (const auto& [key, entry] : value.items()) {
        const std::string indent(size_t(2 * depth), ' ');
        const std::string name = value.is_array() ? "-" : printable(key) + ":";
        if (entry.is_structured() && !entry.empty()) {
            fmt::print("{}{}\n", indent, name);
            printReadable(entry, depth + 1);
        } else
            fmt::print("{}{} {}\n", indent, name,
                       entry.is_string() ? printable(entry.get<std::string>()) : entry.dump());
    }
}

// Joins names, of which it leaves out all beyond a few.
static std::string joined(std::vector<std::string> names, const char* separator) {
    constexpr size_t kMost = 4;
    const size_t count = names.size();
    if (count > kMost) {
        names.resize(kMost);
        names.push_back(fmt::format("{} more", count - kMost));
    }
    return fmt::to_string(fmt::join(names, separator));
}

// Returns the names of the materials in which a part can be shown.
static std::string materialNames(const AssetPart& part) {
    std::vector<std::string> names;
    for (const MaterialSet& set : part.sets)
        for (const AssetMaterial& material : set.materials) names.push_back(printable(material.name));
    return joined(std::move(names), " or ");
}

// Prints what the bake is, in five lines.
static void printSummary(const std::string& file, const Asset& asset, const nlohmann::ordered_json& info) {
    std::vector<std::string> parts;
    for (const AssetPart& part : asset.parts)
        parts.push_back(fmt::format("{} in {}", printable(part.name), materialNames(part)));
    const std::optional<float> share = asset.provenance.bakedShare;
    fmt::print("{}: {:.1f} MB{}, by {} on {}\n", printable(file), info["file_bytes"].get<double>() * 1e-6,
               share ? fmt::format(", a preview with {:.0f} % of its vertices baked", 100 * *share) : "",
               printable(asset.provenance.program), printable(asset.provenance.device));
    fmt::print("{} vertices, {} triangles: {}\n", info["total"]["vertices"].get<uint64_t>(),
               info["total"]["triangles"].get<uint64_t>(), joined(std::move(parts), ", "));
    fmt::print("light: {}, 6 x {}² texels\n",
               asset.bounces == 0   ? std::string("direct only")
               : asset.bounces == 1 ? std::string("direct and one bounce")
                                    : fmt::format("direct and up to {} bounces", asset.bounces),
               asset.faceSize);
    fmt::print(
        "transport: {:.0f} bytes a vertex in memory; keeping at most {} coefficients loses {:.1f} %{}\n",
        info["total"]["bytes_per_vertex"].get<double>(), describeRowEntries(asset),
        100 * double(asset.truncationError),
        asset.layout ? fmt::format(", their layout {:.1f} %", 100 * asset.layout->error) : "");
    fmt::print("visibility: {}\n\n", info["kept_visibility"]["bytes"].get<uint64_t>() > 0
                                         ? "kept: `relume rebake` can take other materials"
                                         : "not kept: other materials need a new bake");
}

// Returns the name of the preset that the options match; null if none does, they are another program's, or
// the layout was converted since.
static nlohmann::json describePreset(const Asset& asset) {
    try {
        const TransportLayout layout = optionsOf(asset).layout.layout;
        for (const AssetPart& part : asset.parts)
            for (const MaterialSet& set : part.sets)
                if (layoutOf(set.transport) != layout) return nullptr;
        if (const auto preset = presetOf(optionsOf(asset))) return presetName(*preset);
    } catch (const Error&) {
    }
    return nullptr;
}

// Returns the bytes that transport takes in the file, compressed.
static uint64_t storedTransport(const ChunkFile& file) {
    uint64_t bytes = 0;
    for (const ChunkEntry& entry : file.entries())
        if (isLayoutTag(entry.tag)) bytes += entry.storedSize;
    return bytes;
}

void addInfoCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand("info", "Say what a bake holds and how it was made");
    struct InfoArguments {
        std::string file;
        bool json = false;
    };
    const auto arguments = std::make_shared<InfoArguments>();
    command->add_option("FILE", arguments->file, "Bake (.relume)")->required();
    command->add_flag("--json", arguments->json, "Print JSON");
    command->callback([arguments] {
        const Asset asset = readAsset(arguments->file);
        const KeptVisibility kept(arguments->file);
        auto info = nlohmann::ordered_json::parse(
            describeAssetJson(asset, std::filesystem::file_size(arguments->file), kept.storedBytes()));
        info["total"]["stored_transport_bytes"] = storedTransport(kept.file());
        info["preset"] = describePreset(asset);
        if (arguments->json)
            fmt::print("{}\n", info.dump(2));
        else {
            printSummary(arguments->file, asset, info);
            printReadable(info, 0);
        }
    });
}

} // namespace relume
