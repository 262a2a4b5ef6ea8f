#include "engine/vk/timing_capture.h"

#include "engine/base/check.h"
#include "engine/vk/device.h"
#include "engine/vk/tick_clock.h"

#include <algorithm>
#include <tuple>

namespace relume::vk {

namespace {

// Recalibrate this often: clocks drift apart by some tens of microseconds a second.
constexpr int64_t kCalibrationAge = 1'000'000'000;

} // namespace

TimingCapture::TimingCapture() : mStart(cpuNanoseconds()) {}

void TimingCapture::attach(const Device& device, ClockMatch best) {
    RELUME_CHECK(!mDevice);
    mDevice = &device;
    if (device.timestampBits() == 0) return;
    mMatch =
        best == ClockMatch::Calibrated && device.readClocks() ? ClockMatch::Calibrated : ClockMatch::Anchored;
    mClock.emplace(double(device.limits().timestampPeriod), device.timestampBits());
    calibrate();
}

void TimingCapture::calibrate() {
    const CpuSpan span(this, "calibrate");
    const ClockReading reading =
        mMatch == ClockMatch::Calibrated ? readCalibrated(*mDevice) : readAnchored(*mDevice);
    mClock->calibrate(reading.ticks, reading.cpu);
    mUncertainty = std::max(mUncertainty, reading.uncertainty);
    mCalibrated = reading.cpu;
}

void TimingCapture::addPasses(std::span<const std::string> names, std::span<const uint64_t> readings) {
    RELUME_CHECK_EQ(readings.size(), 2 * names.size());
    RELUME_CHECK(mClock.has_value());
    const int64_t now = cpuNanoseconds();
    for (size_t i = 0; i < names.size(); i++)
        mPasses.push_back({names[i], mFrame, mClock->sinceFirst(readings[2 * i], now),
                           mClock->sinceFirst(readings[2 * i + 1], now)});
    if (now - mCalibrated > kCalibrationAge) calibrate();
}

TimingTrace TimingCapture::trace() const {
    RELUME_CHECK(!mFrame);
    TimingTrace trace;
    if (mDevice) {
        trace.device = mDevice->info().name;
        trace.driver = mDevice->info().driver;
    }
    trace.clock = mMatch;
    trace.clockUncertainty = mUncertainty;
    using Track = TimingSpan::Track;
    for (const CpuStretch& stretch : mStretches)
        trace.spans.push_back(
            {Track::Cpu, stretch.frame, stretch.name, stretch.start - mStart, stretch.end - stretch.start});
    const auto addGpu = [&](const Pass& pass) {
        const int64_t start = mClock->nanoseconds(pass.start), end = mClock->nanoseconds(pass.end);
        trace.spans.push_back({Track::Gpu, pass.frame, pass.name, start - mStart, end - start});
    };
    // Frames go first, so that they stay ahead of a pass of equal length.
    for (const Pass& frame : gpuFrames()) addGpu(frame);
    for (const Pass& pass : mPasses) addGpu(pass);
    std::stable_sort(trace.spans.begin(), trace.spans.end(), [](const TimingSpan& a, const TimingSpan& b) {
        return std::tuple(a.track, a.start, -a.duration) < std::tuple(b.track, b.start, -b.duration);
    });
    return trace;
}

std::vector<TimingCapture::Pass> TimingCapture::gpuFrames() const {
    std::vector<Pass> frames;
    for (const Pass& pass : mPasses) {
        if (!pass.frame) continue;
        if (frames.empty() || frames.back().frame != pass.frame)
            frames.push_back({"frame", pass.frame, pass.start, pass.end});
        frames.back().start = std::min(frames.back().start, pass.start);
        frames.back().end = std::max(frames.back().end, pass.end);
    }
    return frames;
}

size_t TimingCapture::begin(const char* name) {
    const int64_t now = cpuNanoseconds();
    mStretches.push_back({name, mFrame, now, now});
    return mStretches.size() - 1;
}

CpuSpan::CpuSpan(TimingCapture* capture, const char* name) : mCapture(capture) {
    if (mCapture) mIndex = mCapture->begin(name);
}

void CpuSpan::end() {
    if (mCapture) mCapture->mStretches[mIndex].end = cpuNanoseconds();
    mCapture = nullptr;
}

FrameSpan::FrameSpan(TimingCapture* capture) : mCapture(capture) {
    if (!mCapture) return;
    RELUME_CHECK(!mCapture->mFrame);
    mCapture->mFrame = mCapture->mFrames++;
    mIndex = mCapture->begin("frame");
}

FrameSpan::~FrameSpan() {
    if (!mCapture) return;
    mCapture->mStretches[mIndex].end = cpuNanoseconds();
    mCapture->mFrame.reset();
}

} // namespace relume::vk
