// Work beside the frames, and what is recorded with it.
#include "apps/viewer/worker.h"
#include "engine/import/texture_file.h"

#include "apps/viewer/recorder.h"
#include "engine/base/error.h"
#include "engine/scene/texture.h"
#include "tests/support/temporary_folder.h"

#include <atomic>
#include <doctest/doctest.h>
#include <fmt/core.h>
#include <future>

using namespace relume;
using namespace relume::test;

TEST_CASE("worker: does one thing after the other, and leaves results to who applies them") {
    std::atomic<int> woken = 0;
    std::vector<int> applied;
    std::vector<std::string> failures;
    Worker worker([&] { woken++; });
    CHECK(worker.isIdle());
    worker.wait(); // for nothing
    std::promise<void> begun, mayEnd;
    const auto onError = [&](const std::string& why) { failures.push_back(why); };
    worker.post(
        "first",
        [&]() -> Worker::Result {
            begun.set_value();
            mayEnd.get_future().wait();
            return [&] { applied.push_back(1); };
        },
        onError);
    worker.post(
        "second", []() -> Worker::Result { throw Error("it is gone"); }, onError);
    worker.post(
        "third", [&]() -> Worker::Result { return [&] { applied.push_back(3); }; }, onError);
    begun.get_future().wait();
    CHECK_EQ(worker.title(), "first");
    CHECK_FALSE(worker.isIdle());
    worker.apply();
    CHECK(applied.empty());
    mayEnd.set_value();
    worker.wait();
    CHECK_EQ(worker.title(), "");
    CHECK_FALSE(worker.isIdle()); // results are there
    CHECK(applied.empty());
    worker.apply();
    CHECK_EQ(applied, std::vector{1, 3});
    CHECK_EQ(failures, std::vector<std::string>{"it is gone"});
    CHECK(worker.isIdle());
    worker.apply(); // once
    CHECK_EQ(applied.size(), 2u);
    while (woken < 3) std::this_thread::yield();
}

TEST_CASE("worker: a result may post the next work") {
    int steps = 0;
    Worker worker([] {});
    std::function<void()> next = [&] {
        worker.post("step", [&]() -> Worker::Result { return [&] { ++steps < 3 ? next() : void(); }; }, {});
    };
    next();
    for (int i = 0; i < 3; i++) {
        worker.wait();
        worker.apply();
    }
    CHECK_EQ(steps, 3);
    CHECK(worker.isIdle());
}

TEST_CASE("recorder: writes all frames, by their numbers") {
    const TemporaryFolder folder;
    Recorder recorder(folder.path() / "take");
    constexpr int kFrames = 23; // more than wait
    for (int i = 0; i < kFrames; i++) {
        Image frame(40, 30);
        frame.pixels.assign(frame.pixels.size(), vec4(vec3(float(i) / 255), 1));
        recorder.add(std::move(frame));
    }
    recorder.finish();
    CHECK_EQ(recorder.frames(), kFrames);
    for (int i = 0; i < kFrames; i++) {
        const Texture image = readTexture(recorder.folder() / fmt::format("frame_{:04}.png", i + 1), false);
        CHECK_EQ(image.width, 40);
        CHECK_EQ(image.texels[0] & 0xff, uint32_t(i));
    }
    CHECK_THROWS_WITH_AS(Recorder(folder.path() / "take"),
                         (folder.path() / "take: cannot be made: it is there").c_str(), Error);
}

TEST_CASE("recorder: frames that cannot be written are told at the end, once") {
    const TemporaryFolder folder;
    Recorder recorder(folder.path() / "take");
    recorder.add(Image(4, 4));
    std::filesystem::remove_all(folder.path() / "take");
    for (int i = 0; i < 30; i++) CHECK_NOTHROW(recorder.add(Image(800, 600)));
    CHECK_THROWS_AS(recorder.finish(), Error);
}
