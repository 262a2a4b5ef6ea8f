// The files open in the viewer: bakes on the device, environments, a light file. They are read and baked in
// the background.
#pragma once

#include "apps/viewer/bake_process.h"
#include "apps/viewer/light_choice.h"
#include "apps/viewer/model.h"
#include "apps/viewer/worker.h"

#include <deque>
#include <map>

namespace relume {

// Background work, as shown to the user.
struct Task {
    std::string title;                      // empty: none
    double fraction = -1, secondsLeft = -1; // negative: not shown
    bool canCancel = false;
};

// To be used only from the thread that draws.
class Content {
  public:
    using Tell = std::function<void(const std::string& words, bool isFailure)>;

    // Keeps references to `device` and `light`, whose environments and file it fills; both must outlive it.
    // `wake` is called from another thread when a result is ready.
    Content(const vk::Device& device, const std::string& deviceSelect, LightState& light, Tell tell,
            std::function<void()> wake);

    // Starts reading or baking a file, which is shown once it is ready. A running bake continues after it.
    // Throws Error for a file of unknown kind.
    void open(const std::filesystem::path& file);
    void openBuiltIn();

    // Takes in results of background work. Returns true if a frame must be drawn.
    bool poll();

    // Cancels the running bake; its checkpoint remains.
    void cancelBake();
    // Reads all models again, starting with the one shown.
    void reload();

    // The open bakes, and the one that is shown; null before the first.
    const std::vector<std::shared_ptr<Model>>& models() const { return mModels; }
    const std::shared_ptr<Model>& shown() const { return mShown; }
    void show(size_t model) { mShown = mModels.at(model); }
    void close(size_t model);

    Task task() const;
    bool isBaking() const { return mBake && mBake->isRunning(); }
    // Returns whether nothing is being read or baked, and the newest results are in use.
    bool isSettled() const {
        return mModelWorker.isIdle() && mLightWorker.isIdle() && !mBake && mNextBakes.empty();
    }

    // The files that were opened, newest first.
    void remember(const std::filesystem::path& file);
    const std::vector<std::filesystem::path>& recent() const { return mRecent; }
    void setRecent(std::vector<std::filesystem::path> files) { mRecent = std::move(files); }
    // Returns the mesh or scene from which the viewer baked a file; empty if it did not.
    std::filesystem::path inputOf(const std::filesystem::path& bake) const;

  private:
    struct Bake {
        std::filesystem::path input;
        std::filesystem::path output;
    };
    void bake(const std::filesystem::path& input);
    using OnError = std::function<void(const std::string& why)>;
    void load(const std::filesystem::path& bake, OnError onError);
    void load(const std::filesystem::path& bake);
    void beginBake(const Bake& bake);
    // Shows the scene unshadowed until there is a preview of its bake.
    void sketch(const Bake& bake);
    void take(std::shared_ptr<Model> model);
    std::vector<std::shared_ptr<Model>>::iterator find(const std::filesystem::path& file);
    // Shows a bake if it is open.
    void showOpen(const std::filesystem::path& file);
    void openLight(const std::filesystem::path& file);
    void readEnvironment(size_t number);
    void readNextEnvironment();
    void pollBake();

    const vk::Device& mDevice;
    std::string mDeviceSelect;
    LightState& mLight;
    Tell mTell;
    std::vector<std::shared_ptr<Model>> mModels;
    std::shared_ptr<Model> mShown;
    std::unique_ptr<BakeProcess> mBake;
    std::vector<std::unique_ptr<BakeProcess>> mStopping; // asked to end
    std::deque<Bake> mNextBakes; // wait for those and for reading, then run one by one
    bool mMustReload = false;    // the running bake has written its file since that was read
    bool mHasChanged = false;
    std::vector<std::filesystem::path> mRecent;
    std::map<std::filesystem::path, std::filesystem::path> mInputs; // per bake
    std::filesystem::path mBuiltIn;                                 // empty: not opened
    Worker mModelWorker, mLightWorker;                              // last: their work uses all of the above
};

} // namespace relume
