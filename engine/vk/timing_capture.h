// Records where the time of a sequence of frames goes: every pass of the commands that it is set on, and the
// CPU work that its user names, on one clock. Not thread-safe.
#pragma once

#include "engine/base/timing_trace.h"
#include "engine/vk/tick_clock.h"

#include <span>

namespace relume::vk {

class Device;

// Collects the spans of a capture.
class TimingCapture {
  public:
    // Starts the capture's time at 0.
    TimingCapture();

    // Sets the device whose passes follow, which must outlive the capture. Relates its clock to the CPU's:
    // reads both together if the device supports that and `best` is not Anchored. Call once.
    void attach(const Device& device, ClockMatch best = ClockMatch::Calibrated);

    // Returns all spans so far. A GPU span "frame" reaches from a frame's first timestamp to its last. Call
    // while no CpuSpan or FrameSpan is open.
    TimingTrace trace() const;

    // Takes the report of Commands on a submission that has just ended: pass i ran from reading 2i to 2i + 1.
    void addPasses(std::span<const std::string> names, std::span<const uint64_t> readings);

  private:
    friend class CpuSpan;
    friend class FrameSpan;

    struct CpuStretch {
        std::string name;
        std::optional<uint32_t> frame;
        int64_t start, end; // on the CPU's clock
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
    std::optional<TickClock> mClock; // none if the device has no timestamps
    int64_t mCalibrated = 0;         // time of the last calibration, on the CPU's clock
    int64_t mUncertainty = 0;
    uint32_t mFrames = 0;
    std::optional<uint32_t> mFrame; // the open one
    std::vector<CpuStretch> mStretches;
    std::vector<Pass> mPasses;
};

// Records a span of CPU work, from construction to end() or destruction. Spans nest. Does nothing if
// `capture` is null.
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

// Records a frame as a CPU span "frame"; everything recorded meanwhile belongs to it. `capture` may be null.
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
