#include "apps/relume/input_files.h"

#include "engine/base/error.h"

namespace relume {

void InputFiles::add(const std::filesystem::path& file) {
    std::error_code failure;
    const std::filesystem::path place = std::filesystem::canonical(file, failure);
    if (!failure) mFiles.insert(place);
}

void InputFiles::add(const std::set<std::filesystem::path>& files) {
    for (const std::filesystem::path& file : files) add(file);
}

void InputFiles::expectNone(const char* option, const std::filesystem::path& output) const {
    std::error_code failure;
    const std::filesystem::path place = std::filesystem::canonical(output, failure);
    if (!failure && mFiles.contains(place))
        throw UsageError("{}: {} would be written over, and is read; name another file", option,
                         output.string());
}

} // namespace relume
