// Evaluates a moving light file in the background, since it may have to read images.
#pragma once

#include "apps/viewer/worker.h"
#include "engine/import/moving_light.h"

#include <optional>

namespace relume {

class LightFeed {
  public:
    using OnError = std::function<void(const std::string&)>;
    // `wake` is as for Worker. `onError` is called on the thread that draws.
    LightFeed(std::function<void()> wake, OnError onError);

    // Requests the light at a time. light() may be older until it is ready.
    void want(const std::shared_ptr<MovingLight>& file, double seconds);
    // Returns true if there is a newer light than at the last call.
    bool poll();

    // Returns the light of the file requested last, or null if there is none yet. Every light has its own
    // pointer.
    const std::shared_ptr<const Light>& light() const { return mLight; }
    // Returns the time of that light.
    double seconds() const { return mThere.seconds; }
    // Returns whether the light requested last is there, or failed.
    bool isNewest() const { return mWanted == mThere; }

  private:
    struct Moment {
        std::shared_ptr<MovingLight> file;
        double seconds = 0;
        bool operator==(const Moment&) const = default;
    };
    OnError mOnError;
    Moment mWanted, mThere;
    std::shared_ptr<const Light> mLight;
    bool mIsAsked = false, mHasChanged = false;
    Worker mWorker; // last: its work uses all of the above
};

} // namespace relume
