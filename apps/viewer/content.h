// What is opened: bakes on the device, environments, a light file; and what reads and bakes beside the
// frames.
#pragma once

#include "apps/viewer/bake_process.h"
#include "apps/viewer/light_choice.h"
#include "apps/viewer/model.h"
#include "apps/viewer/worker.h"

#include <deque>
#include <map>

namespace relume {

// Something under way, for people.
struct Task {
    std::string title;                      // empty: nothing
    double fraction = -1, secondsLeft = -1; // below 0: not to be told
    bool canCancel = false;
};

// All of it belongs to the thread that draws.
class Content {
  public:
    using Tell = std::function<void(const std::string& words, bool isFailure)>;

    // `device` and `light`, whose environments and file this fills, must outlive it. `wake` is called from
    // another thread when something is there.
    Content(const vk::Device& device, const std::string& deviceSelect, LightState& light, Tell tell,
            std::function<void()> wake);

    // Begins to read it, or to bake it; it is shown when it is there. A bake in hand goes on after it. Throws
    // Error for a file of no known kind.
    void open(const std::filesystem::path& file);
    void openBuiltIn();

    // Takes in what is there since. True: something else is to be shown.
    bool poll();

    // The one in hand; what it baked is kept.
    void cancelBake();
    // Reads all models anew, the shown one first.
    void reload();

    // The bakes that are open; `shown` among them, null before the first.
    const std::vector<std::shared_ptr<Model>>& models() const { return mModels; }
    const std::shared_ptr<Model>& shown() const { return mShown; }
    void show(size_t model) { mShown = mModels.at(model); }
    void close(size_t model);

    Task task() const;
    bool isBaking() const { return mBake && mBake->isRunning(); }
    // Nothing is read or baked, and the newest of it is there.
    bool isSettled() const { return mWorker.isIdle() && !mBake && mNextBakes.empty(); }

    // Files that were opened, the newest first.
    void remember(const std::filesystem::path& file);
    const std::vector<std::filesystem::path>& recent() const { return mRecent; }
    void setRecent(std::vector<std::filesystem::path> files) { mRecent = std::move(files); }
    // Returns the mesh or scene that a bake was made of in view; empty: none was.
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
    // Shows the scene unshadowed until its bake has a preview.
    void sketch(const Bake& bake);
    void take(std::shared_ptr<Model> model);
    std::vector<std::shared_ptr<Model>>::iterator find(const std::filesystem::path& file);
    // Shows a bake that is open; else nothing changes.
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
    std::vector<std::unique_ptr<BakeProcess>> mStopping; // bakes that were asked to end
    std::deque<Bake> mNextBakes;                         // once they have, one after the other
    bool mMustReload = false;                            // the bake in hand has written since it was read
    bool mHasChanged = false;
    std::vector<std::filesystem::path> mRecent;
    std::map<std::filesystem::path, std::filesystem::path> mInputs; // of bakes
    std::filesystem::path mBuiltIn;                                 // empty: it was not asked for
    Worker mWorker;                                                 // last: its work uses all of the above
};

} // namespace relume
