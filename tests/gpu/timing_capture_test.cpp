#include "engine/import/builtin_mesh.h"
#include "engine/import/timing_file.h"
#include "engine/render/light_pass.h"
#include "engine/render/relighter.h"
#include "engine/render/view_pass.h"
#include "engine/vk/tick_clock.h"
#include "engine/vk/timing_capture.h"
#include "tests/support/diffuse_asset.h"
#include "tests/support/read_timings.h"
#include "tests/support/test_device.h"

#include <random>

using namespace relume;
using vk::CpuSpan;
using vk::FrameSpan;
using vk::TimingCapture;

namespace {

Asset makeAsset() {
    AssetPart part = test::makeDiffusePart(makeSphere(4), 0.5f);
    std::mt19937 random(1);
    auto& transport = part.sets[0].transport.emplace<SparseTransport>();
    transport.vertices = uint32_t(part.mesh.vertexCount());
    transport.terms = 1;
    transport.rowStarts = {0};
    transport.scales.assign(transport.rows(), 1);
    for (size_t row = 0; row < transport.rows(); row++) {
        for (int e = 0; e < 64; e++) {
            transport.indices.push_back(uint16_t(96 * e + int(random() % 96)));
            transport.values.push_back(random());
        }
        transport.rowStarts.push_back(transport.values.size());
    }
    return test::makeTestAsset({part});
}

// Renders frames of a turning camera, and of a sky that turns in every other of them, the way the program
// does.
TimingTrace captureFrames(const vk::Device& device, int frames, ClockMatch clock) {
    TimingCapture capture;
    CpuSpan loading(&capture, "load");
    capture.attach(device, clock);
    const Asset asset = makeAsset();
    LightPass light(device, asset.faceSize);
    light.setEnvironment(prepareForSampling(makeSky(64)));
    Relighter relighter(device, asset);
    ViewPass view(device, asset, {.width = 320, .height = 240});
    vk::Commands commands(device, "timing test");
    commands.setCapture(&capture);
    loading.end();
    for (int frame = 0; frame < frames; frame++) {
        const FrameSpan frameSpan(&capture);
        CpuSpan recording(&capture, "record");
        commands.begin();
        if (frame % 2 == 0) {
            light.record(commands, 0.1f * float(frame));
            relighter.record(commands, light);
        }
        view.record(commands,
                    orbitCamera(boundsOf(asset.parts[0].mesh), 0.1f * float(frame), 0.3f, 1, 0.6f, 1.33f),
                    relighter);
        recording.end();
        commands.submitAndWait();
        const CpuSpan reading(&capture, "read back");
        view.read();
    }
    return capture.trace();
}

} // namespace

TEST_CASE("timing capture: 100 frames nest, fill their GPU time, and stand on the CPU's clock") {
    const TestDevice device;
    for (const ClockMatch clock : {ClockMatch::Calibrated, ClockMatch::Anchored}) {
        const TimingTrace trace = captureFrames(device, 100, clock);
        CAPTURE(nameOf(trace.clock));
        if (clock == ClockMatch::Anchored) CHECK_EQ(trace.clock, ClockMatch::Anchored);
        const auto json = nlohmann::json::parse(chromeTrace(trace));
        CHECK_EQ(json["otherData"]["clock"], nameOf(trace.clock));
        const std::vector<test::ReadSpan> spans = test::readTraceEvents(json);
        // Outside frames: "load" and one "calibrate" or more. In a frame: 5 of the CPU, 6 or 2 of the GPU.
        CHECK_GE(spans.size(), 2u + 50 * (5 + 6) + 50 * (5 + 2));
        test::checkNesting(spans);
        test::checkPassesFillFrames(spans, 100);
        test::checkClocksAgree(spans, 100, json["otherData"]["clock_uncertainty_us"]);
        for (int frame = 0; frame < 100; frame++) {
            for (const char* name : {"frame", "record", "submit", "wait", "read back"})
                test::onlySpan(spans, "CPU", frame, name);
            test::onlySpan(spans, "GPU", frame, "view");
            for (const char* name : {"light sample", "light haar", "light quantize", "relight"})
                if (frame % 2 == 0) test::onlySpan(spans, "GPU", frame, name);
        }
        const std::vector<test::ReadSpan> table = test::readTimingTable(csvTable(trace));
        REQUIRE_EQ(table.size(), spans.size());
        test::checkNesting(table);
        for (size_t i = 0; i < spans.size(); i++) {
            CHECK_EQ(table[i].track, spans[i].track);
            CHECK_EQ(table[i].name, spans[i].name);
            CHECK_EQ(table[i].frame, spans[i].frame);
            CHECK_EQ(table[i].start, doctest::Approx(spans[i].start).epsilon(1e-9));
            CHECK_EQ(table[i].duration, doctest::Approx(spans[i].duration).epsilon(1e-9));
        }
    }
}

TEST_CASE("timing capture: both ways to match the clocks agree") {
    const TestDevice testDevice;
    const vk::Device& device = testDevice;
    if (!device.readClocks() || device.timestampBits() == 0) return;
    const vk::ClockReading calibrated = vk::readCalibrated(device), anchored = vk::readAnchored(device);
    const uint64_t ticks = vk::ticksBetween(calibrated.ticks, anchored.ticks, device.timestampBits());
    const double elapsed = double(ticks) * double(device.limits().timestampPeriod);
    // Some milliseconds apart, in which clocks drift by less than a microsecond.
    CHECK_LE(std::abs(elapsed - double(anchored.cpu - calibrated.cpu)),
             double(calibrated.uncertainty + anchored.uncertainty + 1000));
}

TEST_CASE("timing capture: commands without a capture, and a capture without a device, leave nothing") {
    const TestDevice device;
    TimingCapture capture;
    vk::Commands commands(device, "timing test");
    commands.begin();
    commands.pass("unseen", [] {});
    commands.submitAndWait();
    { const CpuSpan span(&capture, "seen"); }
    { const CpuSpan span(nullptr, "nothing"); }
    const FrameSpan frame(nullptr);
    const TimingTrace trace = capture.trace();
    CHECK_EQ(trace.clock, ClockMatch::None);
    REQUIRE_EQ(trace.spans.size(), 1u);
    CHECK_EQ(trace.spans[0].name, "seen");
}
