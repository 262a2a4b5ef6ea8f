// Results of steps in files, so that an evaluation that was stopped goes on where it was.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace relume {

struct StepResult {
    nlohmann::ordered_json numbers;
    std::vector<std::string> files; // that the step wrote, from the evaluation's folder
    bool isIntact = false;          // the numbers are those that the step gave: earlier versions cannot tell
};

// Results of the steps that are done, by name.
using StepResults = std::map<std::string, StepResult>;

// One file per step, FOLDER/steps/NAME.json, written once the files that it names are there.
class StepStore {
  public:
    explicit StepStore(std::filesystem::path folder) : mFolder(std::move(folder)) {}

    // What was stored under this name with this key, numbers and files unchanged. None: nothing was, or
    // another key, or what is there cannot be read or names files elsewhere.
    std::optional<StepResult> find(const std::string& name, const std::string& key) const;
    // Whether there is a result, of any key, whose name begins so.
    bool hasAny(const std::string& beginning) const;
    // Whole or not at all. Throws Error.
    void store(const std::string& name, const std::string& key, const StepResult& result) const;
    std::filesystem::path pathOf(const std::string& name) const;

  private:
    std::filesystem::path mFolder;
};

} // namespace relume
