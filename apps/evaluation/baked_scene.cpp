#include "apps/evaluation/baked_scene.h"

#include "apps/evaluation/evaluation_folder.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/base/interrupt.h"
#include "engine/base/progress.h"
#include "precompute/bake/baked_options.h"
#include "precompute/visibility/occluder.h"

#include <span>

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

void writeRecord(const std::filesystem::path& path, const BakeRecord& record) {
    const Json json = {
        {"vertices", record.vertices}, {"bytes", record.bytes}, {"ms_per_vertex", record.msPerVertex}};
    writeFileAtomically(path, json.dump() + "\n");
}

std::optional<BakeRecord> readRecord(const std::filesystem::path& path) {
    try {
        const std::vector<std::byte> bytes = readFile(path, 1 << 16);
        const auto* text = reinterpret_cast<const char*>(bytes.data());
        const Json json = Json::parse(text, text + bytes.size());
        return BakeRecord{json.at("vertices"), json.at("bytes"), json.at("ms_per_vertex")};
    } catch (const Error&) {
        return std::nullopt;
    } catch (const Json::exception&) {
        return std::nullopt;
    }
}

std::filesystem::path recordPath(std::filesystem::path bake) { return bake.replace_extension(".json"); }

} // namespace

Json BakeRecipe::key() const {
    Json json = {{"model", model.hash},
                 {"up", model.up == UpAxis::Z ? "z" : "y"},
                 {"triangles", triangles},
                 {"material", material},
                 {"options", describeOptions(options)}};
    if (ground) json["ground"] = {{"tessellation", ground->tessellation}, {"extent", ground->extent}};
    return json;
}

BakeOptions paperOptions(int terms, int coefficients) {
    BakeOptions options;
    options.layout = {.layout = TransportLayout::Rows};
    options.factorization = {.terms = terms, .method = Factorization::Paper};
    options.mapping = DiskMapping::Orthographic;
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

std::filesystem::path BakeStore::pathOf(const BakeRecipe& recipe) const {
    const Json identity = {{"recipe", recipe.key()},
                           {"program", RELUME_VERSION},
                           {"device", mDevice.name()},
                           {"driver", mDevice.info().driver}};
    const std::string key = identity.dump();
    return mFolder / (hashText(std::as_bytes(std::span(key))) + ".relume");
}

BakeRecord BakeStore::make(const BakeRecipe& recipe) const {
    const std::filesystem::path path = pathOf(recipe);
    std::error_code failure;
    if (std::filesystem::is_regular_file(path, failure))
        if (const auto record = readRecord(recordPath(path))) return *record;
    makeFolder(mFolder);
    const Scene scene = makeScene(recipe);
    const auto bake = [&] {
        BarObserver observer("baking " + recipe.name);
        return bakeToFile(mDevice, scene, recipe.options, path, {}, observer);
    };
    BakeSummary summary = bake();
    // Where the checkpoint held nearly all, the time of the rest tells nothing: again, from the first vertex.
    if (10 * (summary.vertices - summary.resumed) < summary.vertices) summary = bake();
    const uint64_t baked = summary.vertices - summary.resumed;
    const BakeRecord record{summary.vertices, summary.bytes, 1e3 * summary.times.total / double(baked)};
    writeRecord(recordPath(path), record);
    return record;
}

Asset BakeStore::read(const BakeRecipe& recipe) const { return readAsset(pathOf(recipe)); }

void BakeStore::remove(const BakeRecipe& recipe) const {
    const std::filesystem::path path = pathOf(recipe);
    std::error_code failure; // what is not there need not go
    for (const auto& file : {path, checkpointPath(path), recordPath(path)})
        std::filesystem::remove(file, failure);
}

} // namespace relume
