// Renders the reference image of the current view in the background, improving with every pass.
#pragma once

#include "apps/viewer/model.h"
#include "precompute/reference/progressive_reference.h"

#include <condition_variable>
#include <mutex>
#include <thread>

namespace relume {

// Renders references on a thread of its own, one view at a time.
class Comparison {
  public:
    // A view and its relit image.
    struct View {
        std::shared_ptr<const Model> model;
        Camera camera;
        LightCube light;
        Appearance appearance;
        Image relit;
        int samples = 1;                  // per pixel
        std::optional<GroundFade> ground; // how `relit` shows the ground; none: all of it
    };
    // The state of the reference.
    struct Result {
        int passes = 0;
        Image reference;
        std::optional<ReferenceError> error; // of the relit image
        std::string failure;                 // why there is no reference; empty if there is
    };

    // `wake` is called from another thread when there is a result.
    explicit Comparison(std::function<void()> wake);
    ~Comparison();
    Comparison(const Comparison&) = delete;
    Comparison& operator=(const Comparison&) = delete;

    // Starts on another view.
    void begin(View view);
    // Stops rendering, drops earlier results and releases the model.
    void stop();
    // Returns the newest result since the last call, if any.
    std::optional<Result> take();
    // The number of passes after which rendering ends.
    static constexpr int kPasses = 1024;

  private:
    void run(std::stop_token stop);
    void publish(Result result, const std::stop_token& stop);
    // Renders one view until another is wanted. Throws Error.
    void work(const View& view, ProgressiveReference& reference, std::stop_token stop);

    std::function<void()> mWake;
    std::mutex mMutex;
    std::condition_variable_any mChanged;
    std::optional<View> mWanted;
    std::stop_source mPass; // of the current view
    std::optional<Result> mResult;
    std::jthread mThread; // last: it uses all of the above
};

} // namespace relume
