#include "engine/render/relighter.h"
#include "precompute/twins/relight_twin.h"
#include "tests/support/asset_sample.h"
#include "tests/support/test_device.h"

#include <doctest/doctest.h>
#include <random>

using namespace relume;

namespace {

// A part of each layout.
Asset makeAsset(int faceSize) {
    std::mt19937 random(21);
    Asset asset;
    asset.faceSize = faceSize;
    const auto add = [&](Transport transport) {
        AssetPart& part = asset.parts.emplace_back();
        part.sets.emplace_back().transport = std::move(transport);
    };
    add(test::sampleTransport(40, 2, faceSize, 60, random));
    add(test::sampleBases(600, 4, faceSize, 500, random));
    add(test::sampleBases(300, 1, faceSize, 90, random));
    add(test::sampleBases(40, 2, faceSize, 0, random));
    return asset;
}

// Lamps that take small steps over a sphere and in size and power, one or two of them at a time.
class LampWalk {
  public:
    LampWalk() {
        for (int i = 0; i < 5; i++)
            mLamps.push_back({glm::normalize(vec3(float(i) - 2, 1, 0.5f)), 0.1f, vec3(20, 15, 10)});
    }

    Light next() {
        const auto step = [&](float size) {
            return std::uniform_real_distribution<float>(-size, size)(mRandom);
        };
        for (uint32_t count = 1 + mRandom() % 2; count > 0; count--) {
            Lamp& lamp = mLamps[mRandom() % mLamps.size()];
            lamp.direction = glm::normalize(lamp.direction + vec3(step(0.1f), step(0.1f), step(0.1f)));
            lamp.angularRadius = std::clamp(lamp.angularRadius + step(0.02f), 0.03f, 0.3f);
            lamp.radiance = glm::clamp(lamp.radiance * (1 + step(0.1f)), vec3(1), vec3(100));
        }
        return {.lamps = mLamps};
    }

  private:
    std::mt19937 mRandom{4};
    std::vector<Lamp> mLamps;
};

class Relighting {
  public:
    Relighting(const Asset& asset, RelightMode mode)
        : mAsset(asset), mLight(mDevice, asset.faceSize), mRelighter(mDevice, asset),
          mCommands(mDevice, "incremental test") {
        mRelighter.setMode(mode);
    }

    LightPass& light() { return mLight; }
    void relight(const LightSelection& selection = {}) {
        mCommands.begin();
        mLight.record(mCommands, 0, selection);
        mRelighter.record(mCommands, mLight);
        mCommands.submitAndWait();
    }
    // Against a relight in full by the CPU twin.
    bool isExact() const {
        const LightVector vector = mLight.readVector();
        for (size_t part = 0; part < mAsset.parts.size(); part++)
            if (mRelighter.readTuples(part) != relume::relight(mAsset.parts[part].sets[0].transport, vector))
                return false;
        return true;
    }
    std::vector<std::vector<vec3>> tuples() const {
        std::vector<std::vector<vec3>> all;
        for (size_t part = 0; part < mAsset.parts.size(); part++) all.push_back(mRelighter.readTuples(part));
        return all;
    }

  private:
    const TestDevice mDevice;
    const Asset& mAsset;
    LightPass mLight;
    Relighter mRelighter;
    vk::Commands mCommands;
};

LightCube makeCube(int faceSize, uint32_t seed, int most) {
    std::mt19937 random(seed);
    LightCube cube{faceSize, {}};
    for (int i = 0; i < 6 * faceSize * faceSize; i++)
        cube.radiance.emplace_back(float(int(random() % uint32_t(2 * most + 1)) - most),
                                   float(int(random() % uint32_t(2 * most + 1)) - most),
                                   float(int(random() % uint32_t(2 * most + 1)) - most));
    return cube;
}

} // namespace

TEST_CASE("incremental relighting: hundreds of steps of lamps end with the bits of a relight in full") {
    for (const RelightMode mode : {RelightMode::Incremental, RelightMode::Auto}) {
        const Asset asset = makeAsset(mode == RelightMode::Incremental ? 64 : 32);
        Relighting changing(asset, mode);
        LampWalk walk;
        int told = 0, small = 0;
        Light light;
        for (int step = 0; step < 400; step++) {
            light = walk.next();
            changing.light().setLight(light);
            changing.relight({.threshold = 100});
            const LightStats stats = changing.light().readStats();
            if (stats.changed) told++;
            if (stats.changed && *stats.changed < stats.kept) small++;
            if (step % 100 == 50) CHECK(changing.isExact());
        }
        // Most steps were made of changes, but the scale changed too.
        CHECK_GT(told, 360);
        CHECK_LT(told, 399);
        CHECK_GT(small, 200);
        CHECK(changing.isExact());

        Relighting full(asset, RelightMode::Full);
        full.light().setLight(light);
        full.relight({.threshold = 100});
        CHECK(changing.tuples() == full.tuples());
    }
}

TEST_CASE("incremental relighting: lights that have little in common are exact") {
    const Asset asset = makeAsset(64);
    for (const RelightMode mode : {RelightMode::Incremental, RelightMode::Auto}) {
        Relighting changing(asset, mode);
        const auto relight = [&](const LightCube& cube, const LightSelection& selection = {}) {
            changing.light().setCube(cube);
            changing.relight(selection);
            CHECK(changing.isExact());
        };
        relight(makeCube(64, 1, 1000), {.threshold = 0});
        relight(makeCube(64, 2, 1000), {.threshold = 0}); // all differs
        relight(makeCube(64, 2, 1000), {.threshold = 0}); // nothing
        CHECK_EQ(changing.light().readStats().changed, 0);
        relight(makeCube(64, 2, 1000), {.count = 7});
        relight(makeCube(64, 3, 1000), {.count = 7});
        relight(makeCube(64, 3, 8), {.count = 7}); // of a finer scale
        CHECK_FALSE(changing.light().readStats().changed);
        relight(LightCube{64, std::vector<vec3>(6 * 64 * 64, vec3(0))}); // black, and black again
        relight(LightCube{64, std::vector<vec3>(6 * 64 * 64, vec3(0))});
        relight(makeCube(64, 3, 8));

        // One texel of the other sign: the largest value turns over, by more than 16 bits.
        LightCube spike{64, std::vector<vec3>(6 * 64 * 64, vec3(0))};
        spike.radiance[100] = vec3(1, -1, 0.5f);
        relight(spike);
        spike.radiance[100] *= -1.0f;
        relight(spike);
        CHECK_FALSE(changing.light().readStats().changed);
    }
}

TEST_CASE("incremental relighting: sums that were left behind start anew") {
    const TestDevice device;
    Asset asset = makeAsset(64);
    for (AssetPart& part : asset.parts) {
        part.sets.push_back(part.sets[0]);
        part.sets[0].materials = part.sets[1].materials = {{"test", "{}"}};
    }
    Appearance other = defaultAppearance(asset);
    for (PartAppearance& part : other) part.set = 1;
    Relighter relighter(device, asset);
    relighter.setMode(RelightMode::Incremental);
    vk::Commands commands(device, "incremental test");
    LightPass lights[] = {LightPass(device, 64), LightPass(device, 64)};
    LampWalk walk;
    std::mt19937 random(8);
    for (int step = 0; step < 40; step++) {
        // Lights that no one relights from, another light, another set, the same light again.
        LightPass& light = lights[random() % 4 == 0];
        light.setLight(walk.next());
        const size_t set = random() % 3 == 0;
        const uint32_t unseen = random() % 4 == 0, again = random() % 4 == 0;
        commands.begin();
        for (uint32_t i = 0; i <= unseen; i++) light.record(commands, float(i));
        for (uint32_t i = 0; i <= again; i++)
            relighter.record(commands, light, set == 0 ? Appearance() : other);
        commands.submitAndWait();
        const LightVector vector = light.readVector();
        for (size_t part = 0; part < asset.parts.size(); part++)
            CHECK(relighter.readTuples(part, set) == relight(asset.parts[part].sets[set].transport, vector));
    }
}
