// The inputs and outputs of one command, and the check that none is overwritten.
#pragma once

#include "engine/base/read_files.h"

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace relume {

// Holds the files of a command against each other before it writes: no output may be an input, nor another
// output, by whatever name. Inputs are those that are added, and all that the process reads from the
// construction on. Links are followed, as writing does.
class CommandFiles {
  public:
    void addInput(const std::filesystem::path& file);
    void addInputs(const std::set<std::filesystem::path>& files);

    // `option` names the file to the user; an empty path is none. `replaced` is an input that it may be.
    void addOutput(const char* option, const std::filesystem::path& file,
                   const std::filesystem::path& replaced = {});

    // Throws UsageError that begins with the option of an output that is an input, or another output.
    void check() const;

  private:
    struct Output {
        std::string option;
        std::filesystem::path file, place, replaced;
    };

    ReadFiles mRead;
    std::set<std::filesystem::path> mInputs; // places: absolute, without links
    std::vector<Output> mOutputs;
};

} // namespace relume
