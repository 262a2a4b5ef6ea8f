#include "precompute/brdf/measured.h"

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "precompute/brdf/cornell.h"
#include "precompute/brdf/material_json.h"
#include "precompute/brdf/merl.h"

#include <fmt/core.h>
#include <utility>

namespace relume {

namespace {

constexpr size_t kMaxFileSize = size_t(64) << 20;

class Measured final : public Brdf {
  public:
    Measured(IsotropicTable table, float scale, std::string path, std::string hash)
        : mTable(std::move(table)), mScale(scale), mPath(std::move(path)), mHash(std::move(hash)) {}

    vec3 evaluate(vec3 incoming, vec3 outgoing) const override {
        return mTable.interpolate(incoming, outgoing) * mScale;
    }

    nlohmann::json describe() const override {
        return {{"measured", mPath}, {"scale", numberToJson(mScale)}, {"hash", mHash}};
    }

  private:
    IsotropicTable mTable;
    float mScale;
    std::string mPath, mHash;
};

// Returns the path; notes a fault if a description cannot hold it as text.
std::filesystem::path readPath(MaterialParameters& parameters) {
    const std::string text = parameters.requiredText("measured");
    if (!canBePath(text))
        parameters.noteFault(
            fmt::format("\"measured\" must be a path of at most {} characters", kMaxPathLength));
    try {
        (void)nlohmann::json(text).dump();
    } catch (const nlohmann::json::exception&) {
        parameters.noteFault("\"measured\" must be a path in UTF-8");
    }
    return text;
}

IsotropicTable parse(const std::vector<std::byte>& bytes, const std::filesystem::path& path) {
    const std::string name = path.generic_string();
    if (path.extension() == ".binary" || looksLikeMerl(bytes)) return parseMerl(bytes, name);
    return parseCornell({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name);
}

} // namespace

std::unique_ptr<Brdf> makeMeasured(MaterialParameters& parameters, const std::filesystem::path& folder) {
    const std::filesystem::path given = readPath(parameters);
    const float scale = parameters.number("scale", 1, {0, 1000});
    const std::string expected = parameters.text("hash", "");
    parameters.noteUnknownKeys();
    parameters.rejectFaults();
    // Make it absolute, so that a bake finds its material from any folder.
    const std::filesystem::path path = std::filesystem::absolute(folder / given).lexically_normal();
    std::error_code failure;
    if (!std::filesystem::exists(path, failure))
        throw Error(fmt::format(
            "{}: measured material not found; give the path of a MERL (.binary) or Cornell (.brdf) "
            "file, or put "
            "the one that a bake was made of back there",
            path.generic_string()));
    const std::vector<std::byte> bytes = readFile(path, kMaxFileSize);
    const std::string hash = hashText(bytes);
    if (!expected.empty() && hash != expected)
        throw Error(fmt::format(
            "{}: is not the file that the material was made from: its hash is {}, not {}; restore that "
            "file, or make the material from this one (bake again, or leave \"hash\" out)",
            path.generic_string(), hash, expected.substr(0, 60)));
    return std::make_unique<Measured>(parse(bytes, path), scale, path.generic_string(), hash);
}

} // namespace relume
