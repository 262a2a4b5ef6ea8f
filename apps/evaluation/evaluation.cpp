#include "apps/evaluation/evaluation.h"

#include "apps/evaluation/expect_no_stop.h"
#include "apps/evaluation/report_html.h"
#include "engine/base/check.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fmt/format.h>
#include <span>
#include <spdlog/spdlog.h>
#include <thread>

namespace relume {

namespace {

using Json = nlohmann::ordered_json;

// Raised when steps give other results from the same inputs.
constexpr int kVersion = 3;

std::string durationText(double seconds) {
    if (seconds < 90) return fmt::format("{:.0f} s", seconds);
    if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
    return fmt::format("{:.1f} h", seconds / 3600);
}

std::string today() {
    const std::time_t now = std::time(nullptr);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", std::gmtime(&now));
    return text;
}

} // namespace

Evaluation::Evaluation(const vk::Device& device, EvaluationOptions options)
    : mDevice(device), mOptions(std::move(options)), mLock(mOptions.output), mStore(mOptions.output),
      mBakes(device, mOptions.output / "bakes") {
    expectWritable(reportPath());
}

std::string Evaluation::keyOf(const Step& step, const std::map<std::string, std::string>& keys) const {
    Json key = {{"program", RELUME_VERSION}, {"version", kVersion},
                {"device", mDevice.name()},  {"driver", mDevice.info().driver},
                {"quick", mOptions.quick},   {"step", step.name},
                {"inputs", step.inputs}};
    for (const BakeRecipe& recipe : step.bakes) key["bakes"].push_back(recipe.key());
    for (const std::string& name : step.after) {
        RELUME_CHECK(keys.contains(name));
        key["after"].push_back(keys.at(name));
    }
    const std::string text = key.dump();
    return hashText(std::as_bytes(std::span(text)));
}

bool Evaluation::isAsked(const std::string& section) const {
    return mOptions.only.empty() || std::ranges::find(mOptions.only, section) != mOptions.only.end();
}

bool Evaluation::isWanted(const std::string& section) const {
    return isAsked(section) || mStore.hasAny(section + "-");
}

std::vector<Evaluation::Planned> Evaluation::plan(const std::vector<Section>& sections) {
    std::vector<Planned> plan;
    std::map<std::string, std::string> keys;
    for (const Section& section : sections)
        for (const Step& step : section.steps) {
            RELUME_CHECK(!keys.contains(step.name) && step.name.starts_with(section.name + "-"));
            const std::string key = keys[step.name] = keyOf(step, keys);
            auto stored = mStore.find(step.name, key);
            if (isAsked(section.name)) plan.push_back({&section, &step, key, stored.has_value()});
            if (stored) mResults[step.name] = std::move(*stored);
        }
    return plan;
}

void Evaluation::tellStart(const std::vector<Planned>& plan, size_t index) const {
    double left = 0;
    for (const Planned& planned : plan)
        if (!planned.done) left += planned.step->seconds;
    // Until a step is done on this machine, there is no telling how fast it is.
    const std::string time =
        mTaken > 0 ? fmt::format(" (about {} left)", durationText(left * mTaken / mExpected)) : "";
    spdlog::info("step {} of {}{}: {}", index + 1, plan.size(), time, plan[index].step->title);
}

void Evaluation::runStep(Planned& planned) {
    const Step& step = *planned.step;
    for (const std::string& name : step.after)
        if (!mResults.contains(name)) {
            mFailures[step.name] = "a step that it needs failed";
            return;
        }
    const auto fail = [&](const char* why) {
        spdlog::error("{}: {}", step.title, why);
        mFailures[step.name] = why;
    };
    const auto start = std::chrono::steady_clock::now();
    try {
        StepRun run(mDevice, mBakes, mOptions.output, step.name);
        StepResult result{step.work(run), {}, true};
        result.files = run.files();
        mStore.store(step.name, planned.key, result);
        mResults[step.name] = std::move(result);
        planned.done = true;
    } catch (const BakeStopped&) {
        throw;
    } catch (const std::bad_alloc&) {
        fail("out of memory");
    } catch (const std::exception& failure) {
        fail(failure.what());
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    spdlog::info("{:.1f} s", seconds);
    mTaken += seconds;
    mExpected += step.seconds;
}

void Evaluation::removeBakes(const std::vector<Planned>& plan, const Step& step) const {
    const auto isNeeded = [&](const BakeRecipe& recipe, Json (BakeRecipe::*key)() const) {
        return std::ranges::any_of(plan, [&](const Planned& other) {
            return !other.done && !mFailures.contains(other.step->name) &&
                   std::ranges::any_of(other.step->bakes, [&](const BakeRecipe& own) {
                       return (own.*key)() == (recipe.*key)();
                   });
        });
    };
    for (const BakeRecipe& recipe : step.bakes) {
        if (!isNeeded(recipe, &BakeRecipe::key)) mBakes.remove(recipe);
        if (!isNeeded(recipe, &BakeRecipe::visibilityKey)) mBakes.removeVisibility(recipe);
    }
}

bool Evaluation::run(const std::vector<Section>& sections, const SceneInputs& inputs) {
    std::vector<Planned> planned = plan(sections);
    const auto done = std::ranges::count(planned, true, &Planned::done);
    spdlog::info("{} steps, {} of them done before", planned.size(), done);
    for (const Planned& one : planned)
        if (one.done) removeBakes(planned, *one.step); // left by a run that was killed
    for (size_t i = 0; i < planned.size(); i++) {
        if (planned[i].done) continue;
        expectNoStop();
        tellStart(planned, i);
        runStep(planned[i]);
        removeBakes(planned, *planned[i].step);
        const bool isLast = i + 1 == planned.size() || planned[i + 1].section != planned[i].section;
        if (isLast) writeReport(sections, inputs);
    }
    writeReport(sections, inputs);
    return mFailures.empty();
}

// Says so of all those whose numbers were stored without a hash, or of all if there are none.
void Evaluation::distrust(const Section& section, const char* why) {
    const auto isTrusted = [&](const Step& step) { return mResults.at(step.name).isIntact; };
    const bool areAllTrusted = std::ranges::all_of(section.steps, isTrusted);
    spdlog::error("{}: its results cannot be read: {}", section.title, why);
    for (const Step& step : section.steps) {
        if (isTrusted(step) && !areAllTrusted) continue;
        const std::string file = mStore.pathOf(step.name).string();
        spdlog::error("{}: may be damaged; delete it, and the same command makes it anew", file);
        mFailures[step.name] = fmt::format(
            "its result may be damaged ({}); delete {}, and the same command makes it anew", why, file);
    }
}

ReportSection Evaluation::reportOf(const Section& section) {
    const auto isDone = [&](const Step& step) {
        return mResults.contains(step.name) && !mFailures.contains(step.name);
    };
    if (std::ranges::all_of(section.steps, isDone)) {
        try {
            ReportSection written{.title = section.title};
            section.write(mResults, written);
            return written;
        } catch (const Json::exception& damage) {
            distrust(section, damage.what());
        }
    }
    ReportSection written{.title = section.title};
    size_t left = 0;
    for (const Step& step : section.steps) {
        const auto failed = mFailures.find(step.name);
        if (failed != mFailures.end())
            written.say(fmt::format("Failed: {}: {}.", step.title, failed->second));
        else if (!mResults.contains(step.name))
            left++;
    }
    if (left > 0)
        written.say(fmt::format("{} of its {} steps are not done yet.", left, section.steps.size()));
    return written;
}

void Evaluation::writeReport(const std::vector<Section>& sections, const SceneInputs& inputs) {
    for (const char* folder : {"tables", "plots"}) makeFolder(mOptions.output / folder);
    Report report;
    report.title = "All-frequency relighting of glossy objects: the evaluation";
    report.facts = {
        {"Program", "relume " RELUME_VERSION},
        {"Options", fmt::format("{}{}", mOptions.quick ? "--quick" : "full",
                                mOptions.data.empty() ? ", installed data alone" : ", with --data")},
        {"Device", fmt::format("{} ({}), {}", mDevice.name(), mDevice.info().type, mDevice.info().driver)},
        {"Processor", fmt::format("{} hardware threads", std::thread::hardware_concurrency())},
        {"Written", today()},
        {"The paper's machine", "Pentium 4, 2.6 GHz, 1 GB, GeForce 5900 (2004)"},
        {"Errors",
         "Root mean square over the covered pixels and channels of the linear image, relative to that of "
         "the reference; free of the reference's noise; in brackets what two standard errors of it leave "
         "open. Pictures are tone-mapped (ACES); .exr files beside them are linear."},
    };
    report.skipped = inputs.missing();
    for (const Section& section : sections) {
        const bool isDone = std::ranges::all_of(
            section.steps, [&](const Step& step) { return mResults.contains(step.name); });
        if (!isAsked(section.name) && (section.steps.empty() || !isDone)) continue;
        report.sections.push_back(reportOf(section));
        for (const std::string& finding : report.sections.back().findings) report.findings.push_back(finding);
        for (const ReportItem& item : report.sections.back().items) {
            if (const auto* table = std::get_if<ReportTable>(&item))
                writeFileAtomically(mOptions.output / "tables" / (table->file + ".csv"), csvOf(*table));
            if (const auto* plot = std::get_if<ReportPlot>(&item))
                writeFileAtomically(mOptions.output / "plots" / (plot->file + ".svg"), plot->svg);
        }
    }
    if (mOptions.quick && !report.findings.empty())
        report.findings.insert(report.findings.begin(),
                               "With --quick: these numbers are for seeing that everything works.");
    writeFileAtomically(reportPath(), htmlOf(report, mOptions.output));
}

} // namespace relume
