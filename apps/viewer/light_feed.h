// The light of a light file at some moment, found beside the frames: it may have to read images.
#pragma once

#include "apps/viewer/worker.h"
#include "engine/import/moving_light.h"

#include <optional>

namespace relume {

class LightFeed {
  public:
    using OnError = std::function<void(const std::string&)>;
    // `wake` as Worker's. `onError` is called on the thread that draws.
    LightFeed(std::function<void()> wake, OnError onError);

    // What is wanted. Something older may be there until it is found.
    void want(const std::shared_ptr<MovingLight>& file, double seconds);
    // True: there is something newer than at the last call.
    bool poll();

    // Of the file that was wanted last; null: nothing yet. Another pointer for another light.
    const std::shared_ptr<const Light>& light() const { return mLight; }
    // Of that light.
    double seconds() const { return mThere.seconds; }
    // What was wanted last is there, or cannot be.
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
