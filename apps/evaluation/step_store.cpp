#include "apps/evaluation/step_store.h"

#include "apps/evaluation/evaluation_folder.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"

#include <algorithm>
#include <span>

namespace relume {

namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kLargestResult = size_t(64) << 20;

std::string hashOf(const Json& numbers) {
    const std::string text = numbers.dump();
    return hashText(std::as_bytes(std::span(text)));
}

// Whether it stays in the folder that it is taken from.
bool isInside(const std::filesystem::path& file) {
    return file.is_relative() && std::ranges::find(file, "..") == file.end();
}

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
        StepResult result{stored.at("numbers"), {}, stored.contains("numbers_hash")};
        if (result.isIntact && stored.at("numbers_hash") != hashOf(result.numbers)) return std::nullopt;
        for (const auto& [file, hash] : stored.at("files").items()) {
            if (!isInside(file) || hashText(readFile(mFolder / file)) != hash) return std::nullopt;
            result.files.push_back(file);
        }
        return result;
    } catch (const Error&) { // a file is gone
        return std::nullopt;
    } catch (const Json::exception&) { // or is no result
        return std::nullopt;
    }
}

bool StepStore::hasAny(const std::string& beginning) const {
    std::error_code failure;
    std::filesystem::directory_iterator entry(mFolder / "steps", failure);
    for (; !failure && entry != std::filesystem::directory_iterator(); entry.increment(failure))
        if (entry->path().filename().string().starts_with(beginning)) return true;
    return false;
}

void StepStore::store(const std::string& name, const std::string& key, const StepResult& result) const {
    Json files = Json::object();
    for (const std::string& file : result.files) files[file] = hashText(readFile(mFolder / file));
    makeFolder(mFolder / "steps");
    const Json stored = {{"key", key},
                         {"numbers", result.numbers},
                         {"numbers_hash", hashOf(result.numbers)},
                         {"files", files}};
    writeFileAtomically(pathOf(name), stored.dump(1) + "\n");
}

} // namespace relume
