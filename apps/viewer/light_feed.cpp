#include "apps/viewer/light_feed.h"

#include <utility>

namespace relume {

LightFeed::LightFeed(std::function<void()> wake, OnError onError)
    : mOnError(std::move(onError)), mWorker(std::move(wake)) {}

void LightFeed::want(const std::shared_ptr<MovingLight>& file, double seconds) {
    if (mWanted.file != file) mLight.reset();
    mWanted = {file, seconds};
    if (isNewest() || mIsAsked) return;
    mIsAsked = true;
    mWorker.post(
        "light", // one at a time; nothing else reads the file
        [this, moment = mWanted]() -> Worker::Result {
            auto light = std::make_shared<const Light>(moment.file->at(moment.seconds));
            return [this, moment, light] {
                mIsAsked = false;
                mHasChanged = true;
                if (moment.file != mWanted.file) return;
                mThere = moment;
                mLight = light;
            };
        },
        [this, moment = mWanted](const std::string& why) {
            mIsAsked = false;
            mHasChanged = true;
            if (moment.file == mWanted.file) mThere = mWanted;
            mOnError(why);
        });
}

bool LightFeed::poll() {
    mWorker.apply();
    return std::exchange(mHasChanged, false);
}

} // namespace relume
