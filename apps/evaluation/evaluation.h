// Sections of the evaluation as steps, and what runs them: each step's result is kept, so that a run that was
// stopped goes on, and the report is written from what is kept.
#pragma once

#include "apps/evaluation/baked_scene.h"
#include "apps/evaluation/report.h"
#include "apps/evaluation/scene_inputs.h"
#include "apps/evaluation/step_store.h"
#include "engine/image/image.h"
#include "engine/vk/device.h"

#include <functional>
#include <map>

namespace relume {

struct EvaluationOptions {
    std::filesystem::path output, data; // data: may be empty
    bool quick = false;
    std::vector<std::string> only; // names of sections that are run; empty: all
};

// Results of the steps that are done, by name.
using StepResults = std::map<std::string, StepResult>;

// What a step may use while it runs.
class StepRun {
  public:
    StepRun(const vk::Device& device, const BakeStore& bakes, const StepResults& results,
            std::filesystem::path folder, std::string step);

    const vk::Device& device;

    // A bake that the step has listed.
    BakeRecord bake(const BakeRecipe& recipe) const { return mBakes.make(recipe); }
    Asset asset(const BakeRecipe& recipe) const;
    // Of a step that this one comes after.
    const nlohmann::ordered_json& numbers(const std::string& step) const;
    Image image(const std::string& step, const std::string& name) const; // linear, as it was written

    // Writes images/STEP/NAME.exr; .png, tone-mapped (ACES) at this exposure in stops; both.
    void writeLinear(const std::string& name, const Image& linear);
    void writeToned(const std::string& name, const Image& linear, float exposure);
    void write(const std::string& name, const Image& linear, float exposure);
    // Display values, as images/STEP/NAME.png.
    void writeDisplay(const std::string& name, const Image& display);
    // Any other file, as images/STEP/NAME.
    void writeText(const std::string& name, const std::string& text);

    const std::vector<std::string>& files() const { return mFiles; }

  private:
    std::string place(const std::string& file); // from the evaluation's folder

    const BakeStore& mBakes;
    const StepResults& mResults;
    std::filesystem::path mFolder;
    std::string mStep;
    std::vector<std::string> mFiles;
};

// Where a picture of a step lies, from the report's folder.
std::filesystem::path pictureOf(const std::string& step, const std::string& name);

// One piece of work, with numbers and files as its result. What decides them must be in the other fields.
struct Step {
    std::string name;                        // among all steps; letters, digits, "-": a file's name
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
    // Throws Error when the folder cannot be written.
    Evaluation(const vk::Device& device, EvaluationOptions options);

    // Runs what is not done yet of these sections, as far as the options ask for them, and writes report.html
    // after each: of them, and of the others that earlier runs have done. A step that fails with an Error is
    // told in the report, and the others go on. Throws BakeStopped when an interrupt was caught. Returns
    // whether none failed.
    bool run(const std::vector<Section>& sections, const SceneInputs& inputs);

    std::filesystem::path reportPath() const { return mOptions.output / "report.html"; }

  private:
    struct Planned {
        const Section* section;
        const Step* step;
        std::string key;
        bool done = false;
    };
    bool isAsked(const Section& section) const;
    std::vector<Planned> plan(const std::vector<Section>& sections); // of those that are asked for
    std::string keyOf(const Step& step, const std::map<std::string, std::string>& keys) const;
    void runStep(Planned& planned);
    void removeBakes(const std::vector<Planned>& plan, const Step& step) const;
    void tellStart(const std::vector<Planned>& plan, size_t index) const;
    ReportSection reportOf(const Section& section) const;
    void writeReport(const std::vector<Section>& sections, const SceneInputs& inputs) const;

    const vk::Device& mDevice;
    EvaluationOptions mOptions;
    StepStore mStore;
    BakeStore mBakes;
    StepResults mResults;
    std::map<std::string, std::string> mFailures; // by step
    double mExpected = 0, mTaken = 0;             // seconds, of the steps that this run did
};

} // namespace relume
