// The inputs and outputs of a command, and the check that no input is overwritten.
#pragma once

#include "engine/base/file.h"

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace relume {

// Throws UsageError, in which `option` names the file, unless its name ends in `extension` (".png").
void expectExtension(const char* option, const std::filesystem::path& file, std::string_view extension);

// Checks the files of a command before it writes: no output may be an input or another output under any name.
// Inputs are those that are added, and every file that the process reads after construction. Symbolic links
// are followed.
class CommandFiles {
  public:
    void addInput(const std::filesystem::path& file);
    void addInputs(const std::set<std::filesystem::path>& files);

    // `option` names the file in messages; an empty path is ignored. `replaced` is an input that the output
    // may replace.
    void addOutput(const char* option, const std::filesystem::path& file,
                   const std::filesystem::path& replaced = {});

    // Throws UsageError, beginning with the output's option, if an output is an input or another output.
    void check() const;

  private:
    struct Output {
        std::string option;
        std::filesystem::path file, place, replaced;
    };

    ReadFiles mRead;
    std::set<std::filesystem::path> mInputs; // absolute, without links
    std::vector<Output> mOutputs;
};

} // namespace relume
