#include "apps/evaluation/baked_scene.h"

#include "apps/evaluation/evaluation_folder.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/base/interrupt.h"
#include "engine/base/progress.h"
#include "engine/transport/kept_visibility.h"
#include "precompute/bake/bake_preset.h"
#include "precompute/bake/baked_options.h"
#include "precompute/visibility/occluder.h"

#include <span>
#include <spdlog/spdlog.h>

namespace relume {

namespace {

using Json = nlohmann::ordered_json;

class BarObserver : public BakeObserver {
  public:
    explicit BarObserver(std::string title) : mTitle(std::move(title)) {}

    void progress(const BakeStatus& status) override {
        if (status.vertices != mVertices) mBar.emplace(mTitle, status.vertices, "vertices");
        mVertices = status.vertices;
        mBar->update({status.done, status.fraction, status.verticesPerSecond, status.secondsLeft});
    }
    bool wantsStop() override { return caughtInterrupt() != 0; }

  private:
    std::string mTitle;
    uint64_t mVertices = 0;
    std::optional<Progress> mBar;
};

std::filesystem::path recordPath(std::filesystem::path bake) { return bake.replace_extension(".json"); }

void writeRecord(const std::filesystem::path& bake, const BakeRecord& record) {
    Json json = {{"vertices", record.vertices}, {"bytes", record.bytes}};
    if (record.msPerVertex) json["ms_per_vertex"] = *record.msPerVertex;
    for (const auto& [stage, ms] : record.msByStage) json["stages"][stage] = ms;
    writeFileAtomically(recordPath(bake), json.dump() + "\n");
}

std::optional<BakeRecord> readRecord(const std::filesystem::path& bake) {
    std::error_code failure;
    if (!std::filesystem::is_regular_file(bake, failure)) return std::nullopt;
    try {
        const std::vector<std::byte> bytes = readFile(recordPath(bake), 1 << 16);
        const auto* text = reinterpret_cast<const char*>(bytes.data());
        const Json json = Json::parse(text, text + bytes.size());
        BakeRecord record{json.at("vertices"), json.at("bytes"), {}, {}};
        if (json.contains("ms_per_vertex")) record.msPerVertex = json.at("ms_per_vertex").get<double>();
        if (json.contains("stages"))
            for (const auto& [stage, ms] : json.at("stages").items())
                record.msByStage.emplace_back(stage, ms.get<double>());
        return record;
    } catch (const Error&) {
        return std::nullopt;
    } catch (const Json::exception&) {
        return std::nullopt;
    }
}

// What is baked, before any refinement.
Json meshKey(const BakeRecipe& recipe) {
    Json json = {{"model", recipe.model.hash},
                 {"up", recipe.model.up == UpAxis::Z ? "z" : "y"},
                 {"triangles", recipe.triangles}};
    if (recipe.ground)
        json["ground"] = {{"tessellation", recipe.ground->tessellation}, {"extent", recipe.ground->extent}};
    return json;
}

// Whether a file keeps visibility. One that should and does not goes.
bool keepsVisibility(const std::filesystem::path& path) {
    std::error_code failure;
    if (!std::filesystem::exists(path, failure)) return false;
    try {
        if (!KeptVisibility(path).key().empty()) return true;
    } catch (const Error&) {
    }
    std::filesystem::remove(path, failure);
    return false;
}

} // namespace

Json BakeRecipe::key() const {
    Json json = meshKey(*this);
    json["material"] = material;
    json["options"] = describeOptions(options);
    return json;
}

Json BakeRecipe::visibilityKey() const {
    Json json = meshKey(*this);
    json["occluder"] = options.occluderTriangles;
    json["size"] = options.visibilitySize;
    json["visibility"] = visibilityMethodName(*options.visibilityMethod);
    if (options.refinement) json["refined"] = key();
    return json;
}

BakeOptions paperOptions(int terms, int coefficients) {
    BakeOptions options = presetOptions(BakePreset::Paper);
    options.factorization.terms = terms;
    options.coefficients = coefficients;
    return options;
}

Scene makeScene(const BakeRecipe& recipe) {
    Scene scene;
    scene.parts = loadParts(recipe.model.file.string(), recipe.model.up, recipe.material);
    if (recipe.triangles > 0) {
        Mesh& mesh = scene.parts.front().mesh;
        mesh = makeOccluder(scene, recipe.triangles).mesh;
        makeNormals(mesh);
    }
    if (recipe.ground) addGround(scene, *recipe.ground);
    return scene;
}

std::filesystem::path BakeStore::pathOf(const Json& key) const {
    const Json identity = {{"recipe", key},
                           {"program", RELUME_VERSION},
                           {"device", mDevice.name()},
                           {"driver", mDevice.info().driver}};
    const std::string text = identity.dump();
    return mFolder / (hashText(std::as_bytes(std::span(text))) + ".relume");
}

std::filesystem::path BakeStore::visibilityPath(const BakeRecipe& recipe) const {
    return pathOf(recipe.visibilityKey());
}

BakeRecord BakeStore::make(const BakeRecipe& recipe) const {
    const std::filesystem::path path = bakePath(recipe), visibility = visibilityPath(recipe);
    if (const auto record = readRecord(path)) return *record;
    makeFolder(mFolder);
    // Refined vertices are of one recipe alone.
    const bool isShared = !recipe.options.refinement, isKept = isShared && keepsVisibility(visibility);
    BakeOptions options = recipe.options;
    options.keepVisibility = isShared && !isKept;
    OutputOptions output; // without a name: what `path` keeps, of a run that was killed before the link
    if (isKept) output.visibility = visibility;
    BarObserver observer("baking " + recipe.name);
    const BakeSummary summary = bakeToFile(mDevice, makeScene(recipe), options, path, {}, observer, output);
    std::error_code failure;
    if (options.keepVisibility) std::filesystem::create_hard_link(path, visibility, failure);
    if (failure)
        spdlog::warn("{}: cannot be linked to ({}); visibility is found anew", path.string(),
                     failure.message());
    const BakeRecord record{summary.vertices, summary.bytes, {}, {}};
    writeRecord(path, record);
    return record;
}

BakeRecord BakeStore::makeTimed(const BakeRecipe& recipe) const {
    const std::filesystem::path path = bakePath(recipe);
    if (const auto record = readRecord(path); record && record->msPerVertex) return *record;
    makeFolder(mFolder);
    std::error_code failure;
    std::filesystem::remove(path, failure); // it may keep visibility
    const Scene scene = makeScene(recipe);
    const auto bake = [&] {
        BarObserver observer("baking " + recipe.name);
        return bakeToFile(mDevice, scene, recipe.options, path, {}, observer);
    };
    BakeSummary summary = bake();
    // Where the checkpoint held nearly all, the time of the rest tells nothing: again, from the first vertex.
    if (10 * (summary.vertices - summary.resumed) < summary.vertices) summary = bake();
    const uint64_t baked = summary.vertices - summary.resumed;
    BakeRecord record{summary.vertices, summary.bytes, 1e3 * summary.times.total / double(baked), {}};
    for (const auto& [name, seconds] : summary.times.device)
        record.msByStage.emplace_back(name, 1e3 * seconds / double(baked));
    writeRecord(path, record);
    return record;
}

Asset BakeStore::read(const BakeRecipe& recipe) const { return readAsset(bakePath(recipe)); }

void BakeStore::remove(const BakeRecipe& recipe) const {
    const std::filesystem::path path = bakePath(recipe);
    std::error_code failure; // what is not there need not go
    for (const auto& file : {path, checkpointPath(path), recordPath(path)})
        std::filesystem::remove(file, failure);
}

void BakeStore::removeVisibility(const BakeRecipe& recipe) const {
    std::error_code failure;
    std::filesystem::remove(visibilityPath(recipe), failure);
}

} // namespace relume
