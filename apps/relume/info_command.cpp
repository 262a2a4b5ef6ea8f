#include "apps/relume/commands.h"
#include "engine/base/error.h"
#include "engine/import/asset_info.h"
#include "engine/transport/asset_arrays.h"
#include "engine/transport/kept_visibility.h"
#include "precompute/bake/bake_options.h"
#include "precompute/bake/baked_options.h"

#include <algorithm>
#include <fmt/format.h>
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
    struct Arguments {
        std::string file;
        bool json = false;
    };
    const auto arguments = std::make_shared<Arguments>();
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
        else
            printReadable(info, 0);
    });
}

} // namespace relume
