// The reference image of what is shown, found beside the frames and better with every pass.
#pragma once

#include "apps/viewer/model.h"
#include "precompute/reference/progressive_reference.h"

#include <condition_variable>
#include <mutex>
#include <thread>

namespace relume {

class Comparison {
  public:
    // A view, and what it was relit to.
    struct View {
        std::shared_ptr<const Model> model;
        Camera camera;
        LightCube light;
        Appearance appearance;
        Image relit;
        int samples = 1; // of its pixels
    };
    // What is known of it so far.
    struct Result {
        int passes = 0;
        Image reference;
        std::optional<ReferenceError> error; // of the relit image
        std::string failure;                 // why there is none; mostly empty
    };

    // `wake` is called from another thread when a result is there.
    explicit Comparison(std::function<void()> wake);
    ~Comparison();
    Comparison(const Comparison&) = delete;
    Comparison& operator=(const Comparison&) = delete;

    // Begins with another view.
    void begin(View view);
    // Nothing is to be found any more; results of before are dropped, and the model is let go.
    void stop();
    // The newest result since the last call; none: nothing new.
    std::optional<Result> take();
    // So many passes are the end.
    static constexpr int kPasses = 1024;

  private:
    void run(std::stop_token stop);
    void publish(Result result, const std::stop_token& stop);
    // One view, until another is wanted. Throws Error.
    void work(const View& view, ProgressiveReference& reference, std::stop_token stop);

    std::function<void()> mWake;
    std::mutex mMutex;
    std::condition_variable_any mChanged;
    std::optional<View> mWanted;
    std::stop_source mPass; // of the view in hand
    std::optional<Result> mResult;
    std::jthread mThread; // last: it uses all of the above
};

} // namespace relume
