#include "precompute/bake/tangents.h"

#include "engine/base/check.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numeric>
#include <tuple>

namespace relume {

namespace {

using Complex = std::complex<double>;
using glm::dvec3;

constexpr double kSmoothing = 0.1; // l, in units of the mesh's radius
constexpr double kMostWeight = 10; // of an edge; slivers exceed it
constexpr double kSolverTolerance = 1e-4;
constexpr int kSolverIterations = 100; // of conjugate gradients, between polls for a stop
constexpr int kMostRounds = 20;

// Returns for each vertex the first one of the same position and normal: vertices are duplicated at seams of
// texture coordinates.
std::vector<uint32_t> firstOfSame(const Mesh& mesh) {
    const auto key = [&](uint32_t i) {
        const vec3 p = mesh.positions[i], n = mesh.normals[i];
        return std::array{p.x, p.y, p.z, n.x, n.y, n.z};
    };
    std::vector<uint32_t> order(mesh.vertexCount());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order,
                      [&](uint32_t a, uint32_t b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
    std::vector<uint32_t> first(mesh.vertexCount());
    for (size_t i = 0; i < order.size(); i++)
        first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
    return first;
}

// Returns the factor of s + i t coordinates that takes a tangent of one frame to another by the shortest
// rotation of the normal; 0 between opposite normals.
Complex transported(const TangentFrame& from, const TangentFrame& to) {
    const float cosine = glm::dot(from.n, to.n);
    if (!(cosine > -0.99f)) return 0;
    const vec3 s = from.s - glm::dot(to.n, from.s) / (1 + cosine) * (from.n + to.n);
    const Complex factor(double(glm::dot(s, to.s)), double(glm::dot(s, to.t)));
    return std::abs(factor) > 1e-6 ? factor / std::abs(factor) : Complex(0);
}

// Returns tangents along u, weighted by the angles of a vertex's corners; 0 where the coordinates determine
// none.
std::vector<vec3> tangentsAlongU(const Mesh& mesh) {
    std::vector<dvec3> sums(mesh.vertexCount(), dvec3(0));
    for (const uvec3& t : mesh.triangles) {
        const dvec3 p[3] = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
        const glm::dvec2 uv[3] = {mesh.uvs[t.x], mesh.uvs[t.y], mesh.uvs[t.z]};
        const glm::dvec2 b = uv[1] - uv[0], c = uv[2] - uv[0];
        const double area = b.x * c.y - c.x * b.y;
        const dvec3 along = (c.y * (p[1] - p[0]) - b.y * (p[2] - p[0])) * (area < 0 ? -1.0 : 1.0);
        const double length = glm::length(along);
        if (area == 0 || !(length > 0)) continue;
        for (int i = 0; i < 3; i++) {
            const dvec3 next = p[(i + 1) % 3] - p[i], last = p[(i + 2) % 3] - p[i];
            const double angle = std::atan2(glm::length(glm::cross(next, last)), glm::dot(next, last));
            sums[t[i]] += angle / length * along;
        }
    }
    return {sums.begin(), sums.end()};
}

} // namespace

std::vector<vec3> smoothTangents(const Mesh& mesh, const std::function<bool()>& wantsStop) {
    const std::vector<uint32_t> first = firstOfSame(mesh);
    const auto count = Eigen::Index(mesh.vertexCount());
    std::vector<TangentFrame> frames;
    for (const vec3& normal : mesh.normals) frames.push_back(tangentFrame(normal));

    std::vector<double> diagonal(mesh.vertexCount(), 0);
    std::vector<Eigen::Triplet<Complex>> entries;
    const double length = kSmoothing * double(boundsOf(mesh).radius());
    Eigen::VectorXcd right = Eigen::VectorXcd::Zero(count);
    for (const uvec3& t : mesh.triangles) {
        const dvec3 p[3] = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
        const double area = 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
        for (int i = 0; i < 3; i++) {
            const uint32_t a = first[t[i]], b = first[t[(i + 1) % 3]];
            const double pull = area / 3 / (length * length);
            diagonal[a] += pull;
            right[a] += pull; // q is 1 in its own frame
            const dvec3 edge = p[(i + 1) % 3] - p[i];
            const double squared = glm::dot(edge, edge);
            const Complex turn = transported(frames[a], frames[b]);
            if (a == b || !(squared > 0) || turn == Complex(0)) continue;
            // Half the cotangent of the opposite angle in an equilateral triangle, and never negative.
            const double weight = std::min(2.0 / 3 * area / squared, kMostWeight);
            diagonal[a] += weight;
            diagonal[b] += weight;
            entries.emplace_back(b, a, -weight * turn);
            entries.emplace_back(a, b, -weight * std::conj(turn));
        }
    }
    for (size_t i = 0; i < mesh.vertexCount(); i++)
        entries.emplace_back(int(i), int(i), diagonal[i] > 0 ? diagonal[i] : 1);
    Eigen::SparseMatrix<Complex> matrix(count, count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    Eigen::ConjugateGradient<Eigen::SparseMatrix<Complex>, Eigen::Lower | Eigen::Upper> solver;
    solver.setTolerance(kSolverTolerance);
    solver.setMaxIterations(kSolverIterations);
    solver.compute(matrix);
    Eigen::VectorXcd field = Eigen::VectorXcd::Ones(count);
    for (int round = 0; round < kMostRounds; round++) {
        if (wantsStop && wantsStop()) return {};
        field = Eigen::VectorXcd(solver.solveWithGuess(right, field));
        if (solver.info() == Eigen::Success) break;
    }

    std::vector<vec3> tangents;
    for (size_t i = 0; i < mesh.vertexCount(); i++) {
        const TangentFrame& frame = frames[i];
        const Complex u = field[first[i]];
        const bool isDirection = std::isfinite(std::abs(u)) && std::abs(u) > 1e-9;
        const vec3 tangent =
            isDirection ? float(u.real() / std::abs(u)) * frame.s + float(u.imag() / std::abs(u)) * frame.t
                        : frame.s;
        tangents.push_back(tangentFrame(frame.n, tangent).s);
    }
    return tangents;
}

bool makeTangents(Mesh& mesh, float degrees, const std::function<bool()>& wantsStop) {
    RELUME_CHECK_EQ(mesh.normals.size(), mesh.vertexCount());
    if (mesh.tangents.empty())
        mesh.tangents = mesh.uvs.empty() ? smoothTangents(mesh, wantsStop) : tangentsAlongU(mesh);
    if (mesh.tangents.empty()) return false;
    const float cosine = std::cos(glm::radians(degrees)), sine = std::sin(glm::radians(degrees));
    for (size_t i = 0; i < mesh.vertexCount(); i++) {
        const TangentFrame frame = frameOf(mesh, i);
        mesh.tangents[i] = tangentFrame(frame.n, cosine * frame.s + sine * frame.t).s;
    }
    return true;
}

} // namespace relume
