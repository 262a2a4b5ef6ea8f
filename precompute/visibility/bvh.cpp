#include "precompute/visibility/bvh.h"

#include "engine/base/check.h"
#include "engine/base/error.h"

#include <algorithm>
#include <array>
#include <embree3/rtcore.h>
#include <fmt/core.h>
#include <limits>
#include <memory>

namespace relume {

namespace {

constexpr unsigned kLeafTriangles = 8;

// A node as Embree's builder makes it: an inner node has children, a leaf has triangles.
struct TreeNode {
    TreeNode* children[shared::kBvhWidth];
    RTCBounds bounds[shared::kBvhWidth];
    unsigned childCount;
    unsigned triangles[kLeafTriangles];
    unsigned triangleCount;
};

TreeNode* newNode(RTCThreadLocalAllocator allocator) {
    auto* node = static_cast<TreeNode*>(rtcThreadLocalAlloc(allocator, sizeof(TreeNode), 16));
    node->childCount = node->triangleCount = 0;
    return node;
}

void* createNode(RTCThreadLocalAllocator allocator, unsigned, void*) { return newNode(allocator); }

void setChildren(void* node, void** children, unsigned count, void*) {
    auto& tree = *static_cast<TreeNode*>(node);
    tree.childCount = count;
    for (unsigned i = 0; i < count; i++) tree.children[i] = static_cast<TreeNode*>(children[i]);
}

void setBounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
    for (unsigned i = 0; i < count; i++) static_cast<TreeNode*>(node)->bounds[i] = *bounds[i];
}

void* createLeaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count,
                 void*) {
    TreeNode* leaf = newNode(allocator);
    leaf->triangleCount = unsigned(count);
    for (size_t i = 0; i < count; i++) leaf->triangles[i] = primitives[i].primID;
    // Embree's threads may deliver primitives in any order.
    std::sort(leaf->triangles, leaf->triangles + count);
    return leaf;
}

vec3 lowOf(const RTCBounds& b) { return {b.lower_x, b.lower_y, b.lower_z}; }
vec3 highOf(const RTCBounds& b) { return {b.upper_x, b.upper_y, b.upper_z}; }

// Assigns every child a free slot whose octant points most towards it; children with the largest dot product
// choose first.
std::array<int, shared::kBvhWidth> assignSlots(const TreeNode& node) {
    Bounds all;
    for (unsigned i = 0; i < node.childCount; i++) {
        all.add(lowOf(node.bounds[i]));
        all.add(highOf(node.bounds[i]));
    }
    struct Wish {
        float cost;
        unsigned child, slot;
    };
    std::vector<Wish> requests;
    for (unsigned child = 0; child < node.childCount; child++) {
        const vec3 towards = 0.5f * (lowOf(node.bounds[child]) + highOf(node.bounds[child])) - all.center();
        for (unsigned slot = 0; slot < shared::kBvhWidth; slot++) {
            const vec3 octant = vec3(slot & 1, slot >> 1 & 1, slot >> 2 & 1) * 2.0f - 1.0f;
            requests.push_back({-glm::dot(towards, octant), child, slot});
        }
    }
    std::ranges::stable_sort(requests, {}, &Wish::cost);
    std::array<int, shared::kBvhWidth> childOfSlot;
    childOfSlot.fill(-1);
    std::array<bool, shared::kBvhWidth> placed{};
    for (const Wish& wish : requests)
        if (!placed[wish.child] && childOfSlot[wish.slot] < 0) {
            childOfSlot[wish.slot] = int(wish.child);
            placed[wish.child] = true;
        }
    return childOfSlot;
}

class Flattener {
  public:
    Flattener(const Mesh& mesh, Bvh& bvh) : mMesh(mesh), mBvh(bvh) {
        const Bounds bounds = boundsOf(mesh);
        const vec3 reach = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
        // Enlarge boxes so that rounding in the shader never culls a hit.
        mMargin = 1e-6f * std::max({reach.x, reach.y, reach.z});
    }

    // Appends a node and its descendants; returns the node's index.
    uint32_t addNode(const TreeNode& node, uint32_t depth) {
        mBvh.depth = std::max(mBvh.depth, depth);
        const auto number = uint32_t(mBvh.children.size() / shared::kBvhWidth);
        constexpr float kInfinity = std::numeric_limits<float>::infinity();
        mBvh.children.resize(mBvh.children.size() + shared::kBvhWidth,
                             {vec3(kInfinity), 0, vec3(-kInfinity), 0});
        const std::array<int, shared::kBvhWidth> childOfSlot = assignSlots(node);
        for (uint32_t slot = 0; slot < shared::kBvhWidth; slot++) {
            if (childOfSlot[slot] < 0) continue;
            const RTCBounds& box = node.bounds[childOfSlot[slot]];
            const uint32_t entry = addEntry(*node.children[childOfSlot[slot]], depth);
            mBvh.children[number * shared::kBvhWidth + slot] = {lowOf(box) - mMargin, entry,
                                                                highOf(box) + mMargin, 0};
        }
        return number;
    }

    uint32_t addLeaf(const TreeNode& leaf) {
        const auto first = uint32_t(mBvh.triangles.size());
        for (unsigned i = 0; i < leaf.triangleCount; i++) {
            const uvec3 t = mMesh.triangles[leaf.triangles[i]];
            mBvh.triangles.push_back({vec4(mMesh.positions[t.x], 0), vec4(mMesh.positions[t.y], 0),
                                      vec4(mMesh.positions[t.z], 0)});
        }
        return shared::kBvhLeaf | (leaf.triangleCount - 1) << shared::kBvhCountShift | first;
    }

  private:
    uint32_t addEntry(const TreeNode& node, uint32_t depth) {
        return node.triangleCount > 0 ? addLeaf(node) : addNode(node, depth + 1);
    }

    const Mesh& mMesh;
    Bvh& mBvh;
    float mMargin;
};

} // namespace

Bvh buildBvh(const Mesh& mesh) {
    constexpr size_t kMostTriangles = size_t(1) << shared::kBvhCountShift;
    if (mesh.triangleCount() > kMostTriangles)
        throw Error(fmt::format(
            "the occluder's {} triangles are more than the {} that can be traced; simplify it: --occluder "
            "TRIANGLES",
            mesh.triangleCount(), kMostTriangles));
    Bvh bvh;
    if (mesh.triangles.empty()) {
        bvh.children.resize(shared::kBvhWidth, {vec3(1), 0, vec3(-1), 0});
        bvh.depth = 1;
        return bvh;
    }
    std::vector<RTCBuildPrimitive> primitives;
    primitives.reserve(mesh.triangleCount());
    for (size_t i = 0; i < mesh.triangleCount(); i++) {
        const uvec3 t = mesh.triangles[i];
        const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const vec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
        primitives.push_back({low.x, low.y, low.z, 0, high.x, high.y, high.z, unsigned(i)});
    }
    const std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device(rtcNewDevice(nullptr),
                                                                           rtcReleaseDevice);
    const std::unique_ptr<RTCBVHTy, decltype(&rtcReleaseBVH)> tree(rtcNewBVH(device.get()), rtcReleaseBVH);
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.maxBranchingFactor = shared::kBvhWidth;
    arguments.maxDepth = 24;
    arguments.sahBlockSize = 8;
    arguments.maxLeafSize = kLeafTriangles;
    arguments.bvh = tree.get();
    arguments.primitives = primitives.data();
    arguments.primitiveCount = arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = createNode;
    arguments.setNodeChildren = setChildren;
    arguments.setNodeBounds = setBounds;
    arguments.createLeaf = createLeaf;
    const auto* root = static_cast<const TreeNode*>(rtcBuildBVH(&arguments));
    if (!root)
        throw Error(fmt::format("out of memory, as it seems: Embree built no hierarchy of the occluder's {} "
                                "triangles; close other programs, or simplify it: --occluder TRIANGLES",
                                mesh.triangleCount()));
    Flattener flattener(mesh, bvh);
    if (root->triangleCount == 0)
        flattener.addNode(*root, 1);
    else { // a single leaf becomes the only child of a node
        TreeNode above{};
        above.childCount = 1;
        above.children[0] = const_cast<TreeNode*>(root);
        const Bounds box = boundsOf(mesh);
        above.bounds[0] = {box.low.x, box.low.y, box.low.z, 0, box.high.x, box.high.y, box.high.z, 0};
        flattener.addNode(above, 1);
    }
    return bvh;
}

} // namespace relume
