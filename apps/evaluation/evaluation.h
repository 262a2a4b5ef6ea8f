// Sections of the evaluation as steps, and what runs them: each step's result is kept, so that a run that was
// stopped goes on, and the report is written from what is kept.
#pragma once

#include "apps/evaluation/evaluation_folder.h"
#include "apps/evaluation/report.h"
#include "apps/evaluation/scene_inputs.h"
#include "apps/evaluation/step_run.h"

#include <functional>

namespace relume {

struct EvaluationOptions {
    std::filesystem::path output, data; // data: may be empty
    bool quick = false;
    std::vector<std::string> only; // names of sections that are run; empty: all
};

// One piece of work, with numbers and files as its result. What decides them must be in the other fields.
struct Step {
    std::string name;                        // SECTION-…, among all; letters, digits, "-": a file's name
    std::string title;                       // "Figure 2: Buddha, K = 1 to 32"
    double seconds = 1;                      // about what it takes, to tell how much time is left
    nlohmann::ordered_json inputs = nullptr; // besides program, device, --quick and the next two
    std::vector<BakeRecipe> bakes = {};      // that StepRun::bake() and asset() are asked for
    std::vector<std::string> after = {};     // steps of the same section whose results it reads
    std::function<nlohmann::ordered_json(StepRun&)> work = {};
};

struct Section {
    std::string name;  // for --only
    std::string title; // "Figure 2: …"
    std::vector<Step> steps;
    // Once all of its steps are done.
    std::function<void(const StepResults&, ReportSection&)> write;
};

// What sections are made of.
struct SectionInputs {
    SceneInputs& scenes;
    bool quick;
};

class Evaluation {
  public:
    // Throws Error when the folder cannot be written, or another evaluation has it.
    Evaluation(const vk::Device& device, EvaluationOptions options);

    // Whether the section of this name is asked for, or may have been done by an earlier run: the others need
    // not be made.
    bool isWanted(const std::string& section) const;

    // Runs what is not done yet of these sections, as far as the options ask for them, and writes report.html
    // after each: of them, and of the others that earlier runs have done. A step that fails is told in the
    // report, and the others go on. Throws BakeStopped when an interrupt was caught. Returns whether none
    // failed.
    bool run(const std::vector<Section>& sections, const SceneInputs& inputs);

    std::filesystem::path reportPath() const { return mOptions.output / "report.html"; }

  private:
    struct Planned {
        const Section* section;
        const Step* step;
        std::string key;
        bool done = false;
    };
    bool isAsked(const std::string& section) const;
    std::vector<Planned> plan(const std::vector<Section>& sections); // of those that are asked for
    std::string keyOf(const Step& step, const std::map<std::string, std::string>& keys) const;
    void runStep(Planned& planned);
    void removeBakes(const std::vector<Planned>& plan, const Step& step) const;
    void tellStart(const std::vector<Planned>& plan, size_t index) const;
    void distrust(const Section& section, const char* why);
    ReportSection reportOf(const Section& section);
    void writeReport(const std::vector<Section>& sections, const SceneInputs& inputs);

    const vk::Device& mDevice;
    EvaluationOptions mOptions;
    FolderLock mLock;
    StepStore mStore;
    BakeStore mBakes;
    StepResults mResults;
    std::map<std::string, std::string> mFailures; // by step
    double mExpected = 0, mTaken = 0;             // seconds, of the steps that this run did
};

} // namespace relume
