// Command recording, one submission at a time: passes with labels and timestamps, dispatches by number of
// items, draws, copies and barriers.
#pragma once

#include "engine/math/vector.h"
#include "engine/vk/buffer.h"
#include "engine/vk/image.h"
#include "engine/vk/program.h"

#include <functional>
#include <initializer_list>
#include <map>

namespace relume::vk {

class TimingCapture;

// One resource of a dispatch or draw. Bindings are given in the order of the shader's binding numbers.
struct Binding {
    Binding(const Buffer& whole) : buffer(&whole), bytes(whole.bytes()) {}
    Binding(const Buffer& part, uint64_t start, uint64_t size) : buffer(&part), offset(start), bytes(size) {}
    Binding(const Image& texture, const Sampler& textureSampler)
        : image(&texture), sampler(&textureSampler) {}

    // Binds the buffer as a texel buffer, which some devices read faster than storage buffers. It covers as
    // many of the first bytes as make whole texels. Programs of portable shaders read it as a storage buffer.
    static Binding texelsOf(const Buffer& buffer, VkFormat format) {
        Binding binding(buffer);
        binding.texelFormat = format;
        return binding;
    }

    const Buffer* buffer = nullptr;
    uint64_t offset = 0, bytes = 0;
    const Image* image = nullptr;
    const Sampler* sampler = nullptr;
    VkFormat texelFormat = VK_FORMAT_UNDEFINED;
};

// Stages between which a barrier orders work: what `from` wrote is visible to `to`.
enum class Stage { Compute, Transfer, Color, Draw, Host };

// The images that a render() draws to.
struct RenderTarget {
    const Image* color = nullptr;
    const Image* depth = nullptr; // may be null; includes the stencil if its format has one
    bool keepsDepth = false;      // keeps the depth and stencil drawn before; else clears them to 1 and 0
    const Image* firstSamples = nullptr; // `depth` is resolved into this, taking sample 0; may be null
    std::array<float, 4> clear{0, 0, 0, 0};
    uint32_t layers = 1;
};

// Seconds of device time per pass name, in order of first use.
using PassTimes = std::vector<std::pair<std::string, double>>;

// Records and submits commands. Keeps a reference to the device, which must outlive it.
class Commands {
  public:
    explicit Commands(const Device& device, std::string_view name);
    ~Commands();
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;

    // Sets where passes of further submissions are reported, with CPU spans "submit" and "wait"; null for
    // nowhere. The capture must outlive its use here.
    void setCapture(TimingCapture* capture) { mCapture = capture; }

    // Turns timestamps of the passes of later recordings on or off; they are on at first. A timed pass waits
    // for all work before it, so leave them off where nobody reads times().
    void setTimed(bool isTimed) { mIsTimed = isTimed; }

    // Starts a new recording; discards the one before.
    void begin();
    // Starts recording into a command buffer of the host program, which is in the recording state and outside
    // of rendering; the host submits it. The device must have finished what these Commands recorded before,
    // so a host needs one Commands per frame in flight. Its passes are not timed.
    void begin(VkCommandBuffer hosts);

    // Records `work` under a debug label. Where passes are timed and the device has timestamps, the first 512
    // passes of a submission are between two timestamps each.
    void pass(const char* name, const std::function<void()>& work);

    // Runs a compute program over at least `items` invocations, rounded up to its group size.
    template <typename Push>
    void dispatch(const ComputeProgram& program, std::initializer_list<Binding> bindings, const Push& push,
                  uvec3 items) {
        dispatchBytes(program, bindings, std::as_bytes(std::span(&push, 1)), items);
    }

    // Attaches and clears the target, then runs `draws`. Images must be in attachment layouts.
    void render(const RenderTarget& target, const std::function<void()>& draws);
    // Binds program, resources and push constants for the draws that follow. Inside render() only.
    template <typename Push>
    void bind(const GraphicsProgram& program, std::initializer_list<Binding> bindings, const Push& push) {
        bindBytes(program, VK_PIPELINE_BIND_POINT_GRAPHICS, bindings, std::as_bytes(std::span(&push, 1)));
    }
    // Sets the value that the program's stencil test writes or compares with. Inside render(), after bind().
    void setStencil(uint32_t value);
    // Sets the positions, a vec3 per vertex, that programs may read. Inside render(), after bind().
    void setPositions(const Buffer& positions);
    void drawIndexed(const Buffer& indices, uint32_t indexCount, uint32_t instances, uint32_t firstIndex = 0);
    // Draws without buffers: the vertex shader knows only the vertex's number.
    void draw(uint32_t vertices);
    void drawIndexedIndirect(const Buffer& indices, const Buffer& draws, uint32_t drawCount,
                             uint64_t firstDraw = 0);

    // Lets another library record its own commands, outside render().
    void recordForeign(const std::function<void(VkCommandBuffer)>& record) { record(mCommands); }

    // Makes all memory that `from` wrote visible to `to`.
    void barrier(Stage from, Stage to);
    // Changes an image's layout, with a barrier from `before` to `after`. Discards its contents if `from` is
    // undefined.
    void transition(const Image& image, VkImageLayout from, VkImageLayout to, Stage before, Stage after);

    void fill(const Buffer& buffer, uint32_t value);
    // Writes a few whole words to the start of a device buffer; they travel with the commands.
    void update(const Buffer& buffer, std::span<const std::byte> bytes);
    void copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t fromOffset = 0,
              uint64_t toOffset = 0);
    // Copies all mip levels, one after the other, each with all its layers. The image must be in
    // TRANSFER_DST. With several levels the buffer must hold nothing else.
    void copy(const Buffer& from, const Image& to);
    void copy(const Buffer& from, uint64_t fromOffset, const Image& to, uint32_t layer); // one layer, level 0
    // Copies level 0 of the first `layers` layers. The image must be in TRANSFER_SRC.
    void copy(const Image& from, const Buffer& to, uint32_t layers, uint64_t toOffset = 0);

    // Submits and waits, then adds the submission's pass times to `times()`.
    void submitAndWait();

    // Returns the timestamps of the last submission as the device wrote them, two per pass.
    std::span<const uint64_t> readings() const { return mReadings; }
    const PassTimes& times() const { return mTimes; }
    void clearTimes() { mTimes.clear(); }

  private:
    explicit Commands(const Device& device);
    void dispatchBytes(const ComputeProgram& program, std::initializer_list<Binding> bindings,
                       std::span<const std::byte> push, uvec3 items);
    void bindBytes(const Program& program, VkPipelineBindPoint point, std::initializer_list<Binding> bindings,
                   std::span<const std::byte> push);
    VkBufferView texelView(const Binding& binding);
    void dropTexelViews();
    void reset();
    VkDescriptorSet allocateSet(VkDescriptorSetLayout layout);
    void orderAllCommands();
    void collectTimes();

    const Device& mDevice;
    VkCommandPool mPool = VK_NULL_HANDLE;
    VkCommandBuffer mOwnCommands = VK_NULL_HANDLE;
    VkCommandBuffer mCommands = VK_NULL_HANDLE; // the own one, or a host's
    VkFence mFence = VK_NULL_HANDLE;
    VkQueryPool mQueries = VK_NULL_HANDLE;
    bool mIsTimed = true, mIsRecordingTimed = false; // as asked for; this recording
    std::vector<VkDescriptorPool> mDescriptorPools;
    size_t mActivePool = 0;
    uint32_t mAllocatedSets = 0;           // of the active pool
    std::vector<VkBufferView> mTexelViews; // made for this recording
    std::vector<std::string> mTimedPasses; // pass i wrote queries 2i and 2i + 1
    std::vector<uint64_t> mReadings;
    PassTimes mTimes;
    TimingCapture* mCapture = nullptr;
};

// Adds seconds to the entry of that name; makes the entry if it is new.
void addTime(PassTimes& times, const std::string& name, double seconds);

// Returns the sum of seconds of all passes whose names start with `prefix`.
double secondsOf(const PassTimes& times, std::string_view prefix = "");

} // namespace relume::vk
