// Explains why shards cannot be joined.
#pragma once

#include "precompute/bake/shard_file.h"

namespace relume {

// Describes what differs between two shards of different bakes: "device: \"B\", not \"A\"" for `other` B,
// `first` A.
std::string describeDifference(const ShardFile& first, const ShardFile& other);

} // namespace relume
