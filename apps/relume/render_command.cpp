#include "apps/relume/appearance_arguments.h"
#include "apps/relume/commands.h"
#include "apps/relume/options.h"
#include "apps/relume/scene_arguments.h"
#include "apps/relume/selection_arguments.h"
#include "apps/relume/session_file.h"
#include "engine/base/error.h"
#include "engine/base/interrupt.h"
#include "engine/base/progress.h"
#include "engine/import/timing_file.h"
#include "engine/render/background_pass.h"
#include "engine/render/relighter.h"
#include "engine/render/view_pass.h"
#include "engine/vk/timing_capture.h"
#include "precompute/bake/bake_options.h"

#include <algorithm>
#include <deque>
#include <fmt/core.h>
#include <functional>
#include <future>
#include <spdlog/spdlog.h>
#include <thread>

namespace relume {

namespace {

struct RenderArguments {
    std::string file;
    std::filesystem::path session;
    CameraArguments camera;
    LightArguments light;
    ImageArguments image;
    AppearanceArguments appearance;
    DeviceArguments device;
    SelectionArguments selection;
    int terms = 0; // 0: all
    BakePreset preset = BakePreset::Default;
    std::optional<bool> residual; // none: the preset's
    int samples = kDefaultSamples;
    int frames = 1;
    float rate = 24; // frames per second of a moving light
    std::string turn = "camera";
    RelightMode mode = RelightMode::Auto;
    std::filesystem::path timings;

    bool isPaper() const { return preset == BakePreset::Paper; }
    bool takesResidual() const { return residual.value_or(!isPaper()); }
    LightSelection lightSelection() const {
        return selection.selection(isPaper() ? LightSelection{.threshold = kPaperLightThreshold}
                                             : LightSelection());
    }
};

// Returns image.png itself, or image_0001.png and so on for several frames.
std::filesystem::path framePath(const RenderArguments& arguments, int frame) {
    if (arguments.frames == 1) return arguments.image.output;
    std::filesystem::path path = arguments.image.output;
    const std::string name =
        fmt::format("{}_{:04}{}", path.stem().string(), frame + 1, path.extension().string());
    return path.replace_filename(name);
}

void checkFiles(const RenderArguments& arguments, const MovingLight& light) {
    CommandFiles files;
    files.addInput(arguments.file);
    files.addInput(arguments.session);
    files.addInputs(light.files());
    arguments.light.addInputs(files);
    for (int frame = 0; frame < arguments.frames; frame++)
        files.addOutput("--output", framePath(arguments, frame));
    files.addOutput("--timings", arguments.timings);
    files.check();
}

// Losses of light selection, over the frames whose light changed.
struct LightLoss {
    uint32_t fewest = UINT32_MAX, most = 0;
    float error = 0;

    void add(const LightStats& stats) {
        fewest = std::min(fewest, stats.kept);
        most = std::max(most, stats.kept);
        error = std::max(error, stats.error);
    }
    void log(int faceSize) const {
        const std::string kept =
            fewest == most ? fmt::format("{}", most) : fmt::format("{} to {}", fewest, most);
        spdlog::info("light: {} of {} coefficients, error {}{:.3g}", kept, 6 * faceSize * faceSize,
                     fewest == most ? "" : "up to ", error);
    }
};

// Writes images on threads of their own, since compressing one takes as long as drawing many.
class ImageWriter {
  public:
    // Images being written take at most about kMostBytes, or are one.
    explicit ImageWriter(size_t pixels)
        : mMost(std::clamp<size_t>(kMostBytes / (kCopies * sizeof(vec4) * pixels), 1,
                                   std::max(1u, std::thread::hardware_concurrency()))) {}

    // Calls `write` on another thread, once few enough images are being written. Throws what an earlier one
    // threw.
    void add(std::function<void()> write) {
        if (mWriting.size() >= mMost) finishFirst();
        mWriting.push_back(std::async(std::launch::async | std::launch::deferred, std::move(write)));
    }

    // Waits until all are written. Throws what one of them threw.
    void finish() {
        while (!mWriting.empty()) finishFirst();
    }

  private:
    static constexpr size_t kMostBytes = size_t(1) << 30, kCopies = 3; // of an image, while it is tone-mapped

    void finishFirst() {
        std::future<void> first = std::move(mWriting.front());
        mWriting.pop_front();
        first.get();
    }

    size_t mMost;
    std::deque<std::future<void>> mWriting;
};

void writeTimings(const std::filesystem::path& path, const vk::TimingCapture& capture) {
    const TimingTrace trace = capture.trace();
    if (trace.clock == ClockMatch::None)
        spdlog::warn("{}: {} writes no timestamps: spans of the CPU alone", path.string(), trace.device);
    if (trace.clock == ClockMatch::Anchored)
        spdlog::warn("{}: {} cannot read its clock together with the CPU's: GPU spans may be {:.1f} µs off "
                     "against CPU spans",
                     path.string(), trace.device, double(trace.clockUncertainty) / 1000);
    writeTimings(path, trace);
}

// Warns of a lamp or distant light that is too small for the bake, if nothing else lights the shadows.
void warnOfSmallLamps(const Light& light, const Asset& asset) {
    if (!light.environments.empty() || light.sky) return;
    const float least = smallestLampRadius(asset);
    float smallest = light.distant.empty() ? kPi : 0;
    for (const Lamp& lamp : light.lamps) smallest = std::min(smallest, lamp.angularRadius);
    if (smallest < least)
        spdlog::warn(
            "a lamp of {:.2g} degrees, alone, has patchy shadows in this bake: make it {:.2g} degrees or "
            "more, or bake with an --error below {:.2g} (docs/errors.md)",
            glm::degrees(smallest), glm::degrees(least),
            asset.layout ? asset.layout->error : kDefaultLayoutError);
}

void run(const RenderArguments& arguments) {
    arguments.image.check();
    std::optional<vk::TimingCapture> timings;
    if (!arguments.timings.empty()) {
        expectTimingFile(arguments.timings);
        timings.emplace();
    }
    vk::TimingCapture* const capture = timings ? &*timings : nullptr;
    vk::CpuSpan loading(capture, "load");
    MovingLight moving = arguments.light.moving(arguments.image.showsLight());
    checkFiles(arguments, moving);
    const Asset asset = readAsset(arguments.file);
    if (const std::optional<float> share = asset.provenance.bakedShare)
        spdlog::warn("{}: is a preview: {:.0f} % of its vertices are baked, the others interpolated",
                     arguments.file, 100 * *share);
    const Appearance appearance = arguments.appearance.appearance(asset);
    const std::unique_ptr<vk::Device> device = arguments.device.open();
    if (capture) capture->attach(*device);
    LightPass light(*device, asset.faceSize);
    std::optional<BackgroundPass> background;
    if (arguments.image.showsLight()) background.emplace(*device);
    const auto setLight = [&](const Light& lit) {
        light.setLight(lit);
        if (background) background->setLight(lit, arguments.image.backgroundBlur());
    };
    const Light first = moving.at(arguments.light.seconds);
    warnOfSmallLamps(first, asset);
    setLight(first);
    Relighter relighter(*device, asset, {.residual = arguments.takesResidual()});
    relighter.setMode(arguments.mode);
    ViewPass view(
        *device, asset,
        {.width = arguments.camera.width, .height = arguments.camera.height, .samples = arguments.samples});
    tellSamples(view.samples(), arguments.samples, *device);
    view.setAppearance(appearance);
    view.setTerms(arguments.terms);
    view.setGroundFade(arguments.image.groundFade(asset));

    const bool turnsBoth = arguments.turn == "both";
    const bool turnsLight = turnsBoth || arguments.turn == "light";
    const bool turnsCamera = turnsBoth || arguments.turn == "camera";
    LightLoss loss;
    float exposure = 0; // that of the first frame for all, so that none flickers
    ImageWriter writer(size_t(arguments.camera.width) * size_t(arguments.camera.height));
    Progress progress("rendering", uint64_t(arguments.frames), "frames");
    vk::Commands commands(*device, "render");
    commands.setCapture(capture);
    loading.end();
    catchInterrupts(); // frames are written whole
    for (int frame = 0; frame < arguments.frames; frame++) {
        const vk::FrameSpan frameSpan(capture);
        const float angle = 2 * kPi * float(frame) / float(arguments.frames);
        const bool lightChanges = frame == 0 || turnsLight || moving.moves();
        if (frame > 0 && moving.moves())
            setLight(moving.at(arguments.light.seconds + double(frame) / double(arguments.rate)));
        vk::CpuSpan recording(capture, "record");
        commands.begin();
        const float rotation = radians(arguments.light.rotationDegrees) + (turnsLight ? angle : 0);
        if (lightChanges) {
            light.record(commands, rotation, arguments.lightSelection());
            relighter.record(commands, light, appearance);
        }
        const Camera camera = arguments.camera.camera(asset, turnsCamera ? angle : 0);
        view.record(commands, camera, relighter);
        if (background) background->record(commands, view.image(), camera, rotation);
        recording.end();
        commands.submitAndWait();
        vk::CpuSpan reading(capture, "read back");
        if (lightChanges) loss.add(light.readStats());
        if (frame == 0) exposure = arguments.image.exposureFor(view.read());
        Image image = background ? background->read() : view.read();
        reading.end();
        const vk::CpuSpan writing(capture, "write image");
        writer.add([&arguments, path = framePath(arguments, frame), image = std::move(image), exposure] {
            arguments.image.write(path, image, exposure);
        });
        if (frame + 1 == arguments.frames || caughtInterrupt() != 0) writer.finish();
        progress.update(uint64_t(frame) + 1);
        if (caughtInterrupt() != 0) break;
    }
    loss.log(asset.faceSize);
    if (capture) writeTimings(arguments.timings, *capture);
    DeviceArguments::expectNoMessages(*device);
    if (caughtInterrupt() != 0) throw CLI::RuntimeError(kExitStopped + caughtInterrupt());
}

void addRelightMode(CLI::App& command, RelightMode& mode) {
    const std::map<std::string, RelightMode> modes = {
        {"full", RelightMode::Full}, {"incremental", RelightMode::Incremental}, {"auto", RelightMode::Auto}};
    addChoice(
        command, "--relight", mode, modes,
        "From all of the light, or what changed of it, or by whichever is less; the images are the same")
        ->type_name("MODE")
        ->default_str("auto");
}

} // namespace

void addRenderCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand("render", "Relight and draw a bake into images");
    const auto arguments = std::make_shared<RenderArguments>();
    command->add_option("FILE,--bake", arguments->file, "Bake (.relume)");
    command
        ->add_option("--session", arguments->session,
                     "A session of the viewer (.json): its bake, view, light and materials; options that are "
                     "given win")
        ->type_name("FILE");
    arguments->image.add(*command);
    arguments->appearance.add(*command);
    arguments->light.add(*command);
    arguments->selection.add(*command);
    command->add_option("--terms", arguments->terms, "Sum the first of the bake's K terms only")
        ->type_name("COUNT")
        ->check(CLI::Range(1, 1024));
    addPreset(*command, arguments->preset,
              "Options to start from: default, or paper, which is --residual off --threshold 1024 "
              "(docs/paper.md); options that are given win");
    command
        ->add_option("--residual", arguments->residual,
                     "Add what the K terms leave of the BRDF, by the share of the light that reaches a point")
        ->check(CLI::IsMember({"on", "off"}))
        ->default_str("on, with --preset paper off");
    arguments->camera.add(*command);
    addSamples(*command, arguments->samples);
    command
        ->add_option("--frames", arguments->frames,
                     "Images, numbered, of one full turn and of --rate a second")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    command->add_option("--turn", arguments->turn, "What turns over the frames: camera, light, both or none")
        ->check(CLI::IsMember({"camera", "light", "both", "none"}))
        ->capture_default_str();
    command->add_option("--rate", arguments->rate, "Frames a second of a light that moves")
        ->check(between(1e-3f, 1e6f))
        ->capture_default_str();
    addRelightMode(*command, arguments->mode);
    arguments->device.add(*command);
    command
        ->add_option("--timings", arguments->timings,
                     "Write what each frame spends its time on: .json for trace viewers, .csv a table")
        ->type_name("FILE");
    command->callback([arguments, command] {
        if (!arguments->session.empty()) applySession(arguments->session, *command);
        if (arguments->file.empty())
            throw UsageError("FILE: expected a bake (.relume), or a --session that names one");
        run(*arguments);
    });
}

} // namespace relume
