// Command recording, one submission at a time: passes with labels and timestamps, dispatches by number
// of items, draws, copies and barriers.
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

// One resource of a dispatch or draw, in the order of the shader's binding numbers.
struct Binding {
    Binding(const Buffer& whole) : buffer(&whole), bytes(whole.bytes()) {}
    Binding(const Buffer& part, uint64_t start, uint64_t size) : buffer(&part), offset(start), bytes(size) {}
    Binding(const Image& texture, const Sampler& textureSampler)
        : image(&texture), sampler(&textureSampler) {}

    // The whole buffer, as many of its first bytes as make texels: read through the texture unit, which some
    // devices do faster than they load, or as a storage buffer where the device takes portable shaders.
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

// Which work waits for which: everything written by `from` is seen by `to`.
enum class Stage { Compute, Transfer, Color, Draw, Host };

struct RenderTarget {
    const Image* color = nullptr;
    const Image* depth = nullptr;        // may be null; with its stencil, if it has one
    bool keepsDepth = false;             // as it was drawn before; else cleared to 1, the stencil to 0
    const Image* firstSamples = nullptr; // takes those of `depth` and its stencil in the end; may be null
    std::array<float, 4> clear{0, 0, 0, 0};
    uint32_t layers = 1;
};

// Seconds of device time by pass name, in order of first use.
using PassTimes = std::vector<std::pair<std::string, double>>;

class Commands {
  public:
    explicit Commands(const Device& device, std::string_view name);
    ~Commands();
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;

    // Where the passes of submissions to come are reported, with CPU spans "submit" and "wait"; null:
    // nowhere.
    void setCapture(TimingCapture* capture) { mCapture = capture; }

    // Starts recording afresh.
    void begin();
    // Starts recording into a host's command buffer, which is in the recording state and outside of
    // rendering; the host submits it. The device must have run what these Commands recorded before: a host
    // has one Commands for each frame in flight.
    void begin(VkCommandBuffer hosts);

    // Records `work` under a debug label and, where the device has them, between two timestamps; those of a
    // submission's first 512 passes.
    void pass(const char* name, const std::function<void()>& work);

    // Runs a compute program over at least `items` invocations; the program knows its group size.
    template <typename Push>
    void dispatch(const ComputeProgram& program, std::initializer_list<Binding> bindings, const Push& push,
                  uvec3 items) {
        dispatchBytes(program, bindings, std::as_bytes(std::span(&push, 1)), items);
    }

    // Attaches the target and clears it, then runs `draws`; images end in the layout they had inside.
    void render(const RenderTarget& target, const std::function<void()>& draws);
    // Inside render(): binds program, resources and push constants for the draws that follow.
    template <typename Push>
    void bind(const GraphicsProgram& program, std::initializer_list<Binding> bindings, const Push& push) {
        bindBytes(program, VK_PIPELINE_BIND_POINT_GRAPHICS, bindings, std::as_bytes(std::span(&push, 1)));
    }
    // Inside render(), after bind(): the value that the program's stencil writes or compares with.
    void setStencil(uint32_t value);
    // Likewise: what a program that reads positions reads, a vec3 a vertex.
    void setPositions(const Buffer& positions);
    void drawIndexed(const Buffer& indices, uint32_t indexCount, uint32_t instances, uint32_t firstIndex = 0);
    // Vertices by number alone.
    void draw(uint32_t vertices);
    void drawIndexedIndirect(const Buffer& indices, const Buffer& draws, uint32_t drawCount,
                             uint64_t firstDraw = 0);

    // Lets a library record what it draws, outside render().
    void recordForeign(const std::function<void(VkCommandBuffer)>& record) { record(mCommands); }

    // `from` before `to`, for all memory.
    void barrier(Stage from, Stage to);
    // Changes an image's layout, keeping nothing of its contents when `from` is undefined.
    void transition(const Image& image, VkImageLayout from, VkImageLayout to, Stage before, Stage after);

    void fill(const Buffer& buffer, uint32_t value);
    // Writes whole words, not many, into a device buffer: they travel with the commands.
    void update(const Buffer& buffer, std::span<const std::byte> bytes);
    void copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t fromOffset = 0,
              uint64_t toOffset = 0);
    // All mip levels, one after the other, and their layers; image in TRANSFER_DST. The buffer holds no more
    // where there are several levels.
    void copy(const Buffer& from, const Image& to);
    void copy(const Buffer& from, uint64_t fromOffset, const Image& to, uint32_t layer); // that layer alone
    // The first layers; image in TRANSFER_SRC.
    void copy(const Image& from, const Buffer& to, uint32_t layers, uint64_t toOffset = 0);

    // Submits and waits; adds this submission's pass times to `times()`.
    void submitAndWait();

    // Timestamps of the last submission as the device wrote them, two a pass.
    std::span<const uint64_t> readings() const { return mReadings; }
    const PassTimes& times() const { return mTimes; }
    void clearTimes() { mTimes.clear(); }

  private:
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
    std::vector<VkDescriptorPool> mDescriptorPools;
    size_t mActivePool = 0;
    std::vector<VkBufferView> mTexelViews; // of this recording
    std::vector<std::string> mTimedPasses; // pass i wrote queries 2i and 2i + 1
    std::vector<uint64_t> mReadings;
    PassTimes mTimes;
    TimingCapture* mCapture = nullptr;
};

// Adds seconds to the entry of that name, which is made if it is new.
void addTime(PassTimes& times, const std::string& name, double seconds);

// Sum of all passes' seconds whose name starts with `prefix`.
double secondsOf(const PassTimes& times, std::string_view prefix = "");

} // namespace relume::vk
