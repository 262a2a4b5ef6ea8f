#include "engine/base/hash.h"

#include <fmt/core.h>
#include <new>
#include <xxhash.h>

namespace relume {

uint64_t hash64(std::span<const std::byte> bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

static std::string textOf(XXH128_hash_t hash) {
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string hashText(std::span<const std::byte> bytes) {
    return textOf(XXH3_128bits(bytes.data(), bytes.size()));
}

struct Hasher::State {
    XXH3_state_t* state = XXH3_createState();
    ~State() { XXH3_freeState(state); }
};

Hasher::Hasher() : mState(std::make_unique<State>()) {
    if (!mState->state) throw std::bad_alloc();
    XXH3_128bits_reset(mState->state);
}
Hasher::~Hasher() = default;

void Hasher::add(std::span<const std::byte> bytes) {
    XXH3_128bits_update(mState->state, bytes.data(), bytes.size());
}

std::string Hasher::text() const { return textOf(XXH3_128bits_digest(mState->state)); }

} // namespace relume
