// The directions in colour space along which a material's transport lies.
#pragma once

#include "engine/scene/factored_brdf.h"
#include "engine/transport/basis_transport.h"

namespace relume {

// Per term the principal directions of its light map, an orthonormal set by falling energy, but for those
// with less than 1e-7 of the term's; for a map whose channels are equal, (1, 1, 1) alone.
std::vector<BasisKind> basisKinds(const FactoredBrdf& brdf);

// The amount of a kind in coefficient `t` is dot(kindDual(kind), t).
inline vec3 kindDual(const BasisKind& kind) { return kind.color / glm::dot(kind.color, kind.color); }

} // namespace relume
