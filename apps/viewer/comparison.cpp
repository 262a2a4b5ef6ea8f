#include "apps/viewer/comparison.h"

#include "engine/base/error_message.h"

#include <chrono>
#include <sys/resource.h>
#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>

namespace relume {

namespace {

using Clock = std::chrono::steady_clock;

// Lowers the thread's priority, so that tracing hardly delays frames. (Linux has priorities per thread.) At
// 19, the lowest, other programs that keep all cores busy would leave it 1.5 % of one, and at 10 a tenth.
void yieldToFrames() { setpriority(PRIO_PROCESS, 0, 10); }

class YieldingThreads : public tbb::task_scheduler_observer {
  public:
    explicit YieldingThreads(tbb::task_arena& arena) : tbb::task_scheduler_observer(arena) { observe(true); }
    ~YieldingThreads() override { observe(false); }
    void on_scheduler_entry(bool) override { yieldToFrames(); }
};

} // namespace

Comparison::Comparison(std::function<void()> wake)
    : mWake(std::move(wake)), mThread([this](std::stop_token stop) { run(stop); }) {}

Comparison::~Comparison() {
    stop();
    mThread.request_stop();
    mThread.join();
}

void Comparison::begin(View view) {
    const std::lock_guard lock(mMutex);
    mPass.request_stop();
    mResult.reset();
    mWanted = std::move(view);
    mChanged.notify_one();
}

void Comparison::stop() {
    const std::lock_guard lock(mMutex);
    mPass.request_stop();
    mResult.reset();
    mWanted = View{}; // no model
    mChanged.notify_one();
}

std::optional<Comparison::Result> Comparison::take() {
    const std::lock_guard lock(mMutex);
    return std::exchange(mResult, std::nullopt);
}

void Comparison::run(std::stop_token stop) {
    yieldToFrames();
    tbb::task_arena arena;
    const YieldingThreads yielding(arena);
    std::shared_ptr<const Model> model; // outlives the reference made from it
    std::unique_ptr<ProgressiveReference> reference;
    for (;;) {
        View view;
        std::stop_token pass;
        {
            std::unique_lock lock(mMutex);
            if (!mChanged.wait(lock, stop, [&] { return mWanted.has_value(); })) return;
            view = *std::exchange(mWanted, std::nullopt);
            mPass = {};
            pass = mPass.get_token();
        }
        arena.execute([&] {
            try {
                if (model != view.model) {
                    reference.reset();
                    model = view.model;
                    if (model) reference = std::make_unique<ProgressiveReference>(model->asset);
                }
                if (reference) work(view, *reference, pass);
            } catch (const std::exception& why) { // missing measured data, too little memory
                reference.reset();
                model.reset();
                publish({.failure = errorMessage(why)}, pass);
            }
        });
    }
}

void Comparison::publish(Result result, const std::stop_token& stop) {
    {
        const std::lock_guard lock(mMutex);
        if (stop.stop_requested()) return;
        mResult = std::move(result);
    }
    mWake();
}

void Comparison::work(const View& view, ProgressiveReference& reference, std::stop_token stop) {
    reference.restart(view.camera, view.light, view.appearance, view.relit.width, view.relit.height,
                      view.samples, view.ground);
    Clock::time_point shown;
    while (reference.passes() < kPasses && reference.addPass(stop)) {
        // Publish rarely: every result shown costs a frame.
        constexpr auto kBetween = std::chrono::milliseconds(400);
        const bool isLast = reference.passes() == kPasses;
        if (Clock::now() - shown < kBetween && !isLast) continue;
        publish({reference.passes(), reference.mean(), reference.errorOf(view.relit), ""}, stop);
        shown = Clock::now();
    }
}

} // namespace relume
