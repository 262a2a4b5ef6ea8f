#include "apps/evaluation/step_store.h"

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"

namespace relume {

namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kLargestResult = size_t(64) << 20;

} // namespace

std::filesystem::path StepStore::pathOf(const std::string& name) const {
    return mFolder / "steps" / (name + ".json");
}

std::optional<StepResult> StepStore::find(const std::string& name, const std::string& key) const {
    try {
        const std::vector<std::byte> bytes = readFile(pathOf(name), kLargestResult);
        const auto* text = reinterpret_cast<const char*>(bytes.data());
        const Json stored = Json::parse(text, text + bytes.size());
        if (stored.at("key") != key) return std::nullopt;
        StepResult result{stored.at("numbers"), {}};
        for (const auto& [file, hash] : stored.at("files").items()) {
            if (hashText(readFile(mFolder / file)) != hash) return std::nullopt;
            result.files.push_back(file);
        }
        return result;
    } catch (const Error&) { // a file is gone
        return std::nullopt;
    } catch (const Json::exception&) { // or is no result
        return std::nullopt;
    }
}

void StepStore::store(const std::string& name, const std::string& key, const StepResult& result) const {
    Json files = Json::object();
    for (const std::string& file : result.files) files[file] = hashText(readFile(mFolder / file));
    std::filesystem::create_directories(mFolder / "steps");
    const Json stored = {{"key", key}, {"numbers", result.numbers}, {"files", files}};
    writeFileAtomically(pathOf(name), stored.dump(1) + "\n");
}

} // namespace relume
