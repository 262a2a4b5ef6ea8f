#include "apps/relume/command_files.h"

#include "engine/base/error.h"

#include <fmt/core.h>
#include <map>

namespace relume {

namespace {

// Returns a path that is the same for all names of a file, which need not exist yet.
std::filesystem::path placeOf(const std::filesystem::path& file) {
    std::error_code failure;
    const std::filesystem::path whole = std::filesystem::absolute(file);
    const std::filesystem::path place = std::filesystem::weakly_canonical(whole, failure);
    return failure ? whole.lexically_normal() : place;
}

} // namespace

void expectExtension(const char* option, const std::filesystem::path& file, std::string_view extension) {
    if (file.extension() != extension)
        throw UsageError(
            fmt::format("{}: expected a name ending in {}, found \"{}\"", option, extension, file.string()));
}

void CommandFiles::addInput(const std::filesystem::path& file) {
    if (!file.empty()) mInputs.insert(placeOf(file));
}

void CommandFiles::addInputs(const std::set<std::filesystem::path>& files) {
    for (const std::filesystem::path& file : files) addInput(file);
}

void CommandFiles::addOutput(const char* option, const std::filesystem::path& file,
                             const std::filesystem::path& replaced) {
    if (file.empty()) return;
    mOutputs.push_back({option, file, placeOf(file), replaced.empty() ? "" : placeOf(replaced)});
}

void CommandFiles::check() const {
    std::set<std::filesystem::path> inputs = mInputs;
    for (const std::filesystem::path& file : mRead.paths()) inputs.insert(placeOf(file));
    std::map<std::filesystem::path, const Output*> outputs;
    for (const Output& output : mOutputs) {
        if (output.place != output.replaced && inputs.contains(output.place))
            throw UsageError(fmt::format("{}: {} would be written over, and is read; name another file",
                                         output.option, output.file.string()));
        const auto [first, isNew] = outputs.try_emplace(output.place, &output);
        if (!isNew)
            throw UsageError(fmt::format("{}: {} is what {} writes too; name another file", output.option,
                                         output.file.string(), first->second->option));
    }
}

} // namespace relume
