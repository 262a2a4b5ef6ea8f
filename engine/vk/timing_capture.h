// Records what a run of frames spends its time on: every pass of the commands that it is given to, and the
// stretches of CPU work that its user names, on one clock. One thread.
#pragma once

#include "engine/base/timing_trace.h"
#include "engine/vk/tick_clock.h"

#include <span>

namespace relume::vk {

class Device;

class TimingCapture {
  public:
    // Time starts to count.
    TimingCapture();

    // The device whose passes follow; must outlive this. Finds how its clock stands to the CPU's: with both
    // read together where the device offers that, and `best` is not Anchored. Once.
    void attach(const Device& device, ClockMatch best = ClockMatch::Calibrated);

    // All spans so far; a GPU span "frame" reaches from a frame's first timestamp to its last. When no
    // CpuSpan and no FrameSpan is open.
    TimingTrace trace() const;

    // Commands' report of a submission that has just ended: pass i ran from reading 2i to reading 2i + 1.
    void addPasses(std::span<const std::string> names, std::span<const uint64_t> readings);

  private:
    friend class CpuSpan;
    friend class FrameSpan;

    struct CpuStretch {
        std::string name;
        std::optional<uint32_t> frame;
        int64_t start, end; // of the CPU's clock
    };
    struct Pass {
        std::string name;
        std::optional<uint32_t> frame;
        int64_t start, end; // ticks since the clock's first calibration
    };

    std::vector<Pass> gpuFrames() const;
    size_t begin(const char* name);
    void calibrate();

    int64_t mStart;
    const Device* mDevice = nullptr;
    ClockMatch mMatch = ClockMatch::None;
    std::optional<TickClock> mClock; // none where the device has no timestamps
    int64_t mCalibrated = 0;         // when it was, of the CPU's clock
    int64_t mUncertainty = 0;
    uint32_t mFrames = 0;
    std::optional<uint32_t> mFrame; // the one that is open
    std::vector<CpuStretch> mStretches;
    std::vector<Pass> mPasses;
};

// CPU work from construction to end() or destruction. Spans nest. `capture` may be null: then nothing
// happens.
class CpuSpan {
  public:
    CpuSpan(TimingCapture* capture, const char* name);
    ~CpuSpan() { end(); }
    CpuSpan(const CpuSpan&) = delete;
    CpuSpan& operator=(const CpuSpan&) = delete;

    void end();

  private:
    TimingCapture* mCapture;
    size_t mIndex = 0;
};

// A frame, the span "frame" of the CPU; everything meanwhile belongs to it. `capture` may be null.
class FrameSpan {
  public:
    explicit FrameSpan(TimingCapture* capture);
    ~FrameSpan();
    FrameSpan(const FrameSpan&) = delete;
    FrameSpan& operator=(const FrameSpan&) = delete;

  private:
    TimingCapture* mCapture;
    size_t mIndex = 0;
};

} // namespace relume::vk
