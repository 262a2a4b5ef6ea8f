#include "engine/import/environment_files.h"
#include "engine/import/environment_file.h"

#include "engine/base/error.h"

#include <algorithm>
#include <fmt/core.h>
#include <map>
#include <string_view>

namespace relume {

namespace {

constexpr size_t kMostMaps = 64;    // at most 1.5 MiB each
constexpr size_t kMostPictures = 4; // at most 384 MiB each; the light of one moment needs no more

// Compares digits by value, whatever the number of leading zeros.
struct ByNumber {
    static std::string_view significant(std::string_view digits) {
        return digits.substr(std::min(digits.find_first_not_of('0'), digits.size()));
    }
    bool operator()(const std::string& a, const std::string& b) const {
        const std::string_view p = significant(a), q = significant(b);
        return p.size() != q.size() ? p.size() < q.size() : p < q;
    }
};

std::vector<std::filesystem::path> sequenceFiles(const std::filesystem::path& pattern) {
    const std::string name = pattern.filename();
    const size_t start = name.find('#'), end = name.find_first_not_of('#', start);
    const std::string prefix = name.substr(0, start), suffix = end < name.size() ? name.substr(end) : "";
    if (start == std::string::npos || suffix.find('#') != std::string::npos)
        throw Error(fmt::format("{}: expected one run of # in the file's name, where its number is",
                                pattern.string()));
    const std::filesystem::path folder = pattern.has_parent_path() ? pattern.parent_path() : ".";
    std::error_code failure;
    std::map<std::string, std::filesystem::path, ByNumber> files;
    for (std::filesystem::directory_iterator entry(folder, failure), none; !failure && entry != none;
         entry.increment(failure)) {
        const std::string candidate = entry->path().filename();
        if (candidate.size() <= prefix.size() + suffix.size() || !candidate.starts_with(prefix) ||
            !candidate.ends_with(suffix))
            continue;
        const std::string digits =
            candidate.substr(prefix.size(), candidate.size() - prefix.size() - suffix.size());
        if (digits.find_first_not_of("0123456789") != std::string::npos) continue;
        const auto [place, isNew] = files.emplace(digits, folder / candidate);
        if (!isNew)
            throw Error(fmt::format("{}: expected one file of each number, found {} and {}", pattern.string(),
                                    place->second.filename().string(), candidate));
    }
    if (failure) throw Error(fmt::format("{}: {}", folder.string(), failure.message()));
    if (files.empty())
        throw Error(
            fmt::format("{}: expected files with a number in place of #, found none", pattern.string()));
    std::vector<std::filesystem::path> sorted;
    for (auto& [number, file] : files) sorted.push_back(file);
    return sorted;
}

} // namespace

std::shared_ptr<const Environment> EnvironmentFiles::map(const std::filesystem::path& file) {
    if (!file.empty()) mNamed.insert(file);
    if (const auto known = find(mMaps, file)) return known;
    if (file.empty()) {
        keep(mMaps, kMostMaps, file, std::make_shared<const Environment>(prepareForSampling(makeSky())));
        return mMaps.front().second;
    }
    Environment whole = readEnvironment(file);
    auto map = std::make_shared<const Environment>(prepareForSampling(whole));
    keep(mMaps, kMostMaps, file, map);
    if (mKeepsPictures) keep(mPictures, kMostPictures, file, makePicture(std::move(whole)));
    return map;
}

std::shared_ptr<const Environment> EnvironmentFiles::picture(const std::filesystem::path& file) {
    if (!mKeepsPictures) return nullptr;
    if (const auto known = find(mPictures, file)) return known;
    keep(mPictures, kMostPictures, file,
         makePicture(file.empty() ? makeSky(kSkyPictureColumns) : readEnvironment(file)));
    return mPictures.front().second;
}

std::shared_ptr<const Environment> EnvironmentFiles::find(Kept& kept, const std::filesystem::path& file) {
    const auto found = std::ranges::find(kept, file, [](const auto& entry) { return entry.first; });
    if (found == kept.end()) return nullptr;
    kept.splice(kept.begin(), kept, found);
    return found->second;
}

void EnvironmentFiles::keep(Kept& kept, size_t most, const std::filesystem::path& file,
                            std::shared_ptr<const Environment> environment) {
    kept.emplace_front(file, std::move(environment));
    if (kept.size() > most) kept.pop_back();
}

const std::vector<std::filesystem::path>& EnvironmentFiles::sequence(const std::filesystem::path& pattern) {
    const auto found = mSequences.find(pattern);
    if (found != mSequences.end()) return found->second;
    const auto& files = mSequences.emplace(pattern, sequenceFiles(pattern)).first->second;
    mNamed.insert(files.begin(), files.end());
    return files;
}

bool isSequence(const std::filesystem::path& path) {
    std::error_code failure;
    return path.filename().string().find('#') != std::string::npos && !std::filesystem::exists(path, failure);
}

} // namespace relume
